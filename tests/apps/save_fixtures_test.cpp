// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/fixture_editor.h"
#include "tests/apps/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

TEST_CASE("Names with quotes and backslashes are saved so that they are read back unchanged") {
    const ScratchFolder folder;
    const auto file = folder.path() / "scene.yaml";
    put(file,
        "fixtures:\n  - { name: red, role: forbidden, hue: [0, 20] }\n"
        "tool: { spheres: [[0, 0, 0, 0.01]] }\npilots:\n  - { name: Ben }\n  - { name: 'Ann \\ \"B\"' }\n");
    Scene scene = loadScene(file);
    scene.fixtures[0].name = "say \"hi\" \\ there and here";
    FixtureEditor editor(scene, [](const Scene&, const std::vector<Shape>&) {});
    editor.keep({}, "Ann \\ \"B\"");
    put(file, editor.text());
    const Scene again = loadScene(file);
    CHECK(again.fixtures[0].name == scene.fixtures[0].name);
    CHECK(again.pilot == "Ann \\ \"B\"");
}
