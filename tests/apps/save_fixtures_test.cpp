// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/fixture_editor.h"
#include "tests/rig/file_size_limit.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <string>
#include <utility>
#include <vector>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

constexpr const char* kRest = "\n# The tool.\ntool: { spheres: [[0, 0, 0, 0.01]] }\n";

FixtureEditor editorOf(const std::filesystem::path& file) {
    return {loadScene(file), [](const Scene&, const std::vector<Shape>&) {}};
}

std::string withCarriageReturns(std::string text) {
    for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
        text.replace(at, 1, "\r\n");
    }
    return text;
}

} // namespace

TEST_CASE("Names with quotes and backslashes are saved so that they are read back unchanged") {
    const ScratchFolder folder;
    const auto file = folder.path() / "scene.yaml";
    put(file,
        "fixtures:\n  - { name: red, role: forbidden, hue: [0, 20] }\n"
        "tool: { spheres: [[0, 0, 0, 0.01]] }\npilots:\n  - { name: Ben }\n  - { name: 'Ann \\ \"B\"' }\n");
    Scene scene = loadScene(file);
    scene.fixtures[0].name = "say \"hi\" \\ there and here";
    FixtureEditor editor(scene, [](const Scene&, const std::vector<Shape>&) {});
    editor.keepSettings({}, "Ann \\ \"B\"");
    put(file, editor.text());
    const Scene again = loadScene(file);
    CHECK(again.fixtures[0].name == scene.fixtures[0].name);
    CHECK(again.pilot == "Ann \\ \"B\"");
}

TEST_CASE("Saving keeps blank lines and comments after the fixtures, and the line ends of the file") {
    const ScratchFolder folder;
    const auto file = folder.path() / "scene.yaml";
    const std::string row = "{ name: \"red\", role: forbidden, hue: [0, 20], radius: 0.04 }";
    const std::string typed = "{name: red, hue: [0, 20.0], radius: 0.040, role: forbidden}"; // by hand
    const std::string saved = "fixtures:\n  - " + row + "\n\n" + kRest;
    const std::vector<std::pair<std::string, std::string>> beforeAndAfter{
        {saved, saved},
        {"fixtures:\n  - " + typed + "\n\n" + kRest, saved},
        {"fixtures: [\n\n  " + typed + "\n]\n\n" + kRest, saved},
        {kRest + ("\nfixtures:\n  - " + typed) + "\n# end\n",
         kRest + ("\nfixtures:\n  - " + row) + "\n# end\n"}};
    for (const auto& [before, after] : beforeAndAfter) {
        put(file, before);
        CHECK(editorOf(file).save() == "1 fixtures saved to " + file.string());
        CHECK(textOf(file) == after);
        put(file, withCarriageReturns(before));
        CHECK(editorOf(file).save() == "1 fixtures saved to " + file.string());
        CHECK(textOf(file) == withCarriageReturns(after));
    }
}

TEST_CASE("A shape far from the base is saved to the last bit") {
    const ScratchFolder folder;
    const auto file = folder.path() / "scene.yaml";
    put(file,
        std::string("fixtures:\n  - { name: ball, role: forbidden, shape: sphere, size: [0.1, 0, 0] }\n") +
            kRest);
    FixtureEditor editor = editorOf(file);
    FixtureClass ball = editor.scene().fixtures[0];
    ball.baseTshape.position = {1e6 - 1.0 / 3.0, -1e-7 / 3.0, 0.1};
    editor.change(0, ball);
    CHECK(editor.save() == "1 fixtures saved to " + file.string());
    CHECK(loadScene(file).fixtures[0].baseTshape.position == ball.baseTshape.position);
}

TEST_CASE("Saving on a full disk leaves the scene as it was and says why; saving again succeeds") {
    const ScratchFolder folder;
    const auto file = folder.path() / "scene.yaml";
    const std::string text = std::string("fixtures: []\n") + kRest +
                             "\n# a comment, where the disk is full: what is cut loads, too\n" +
                             "haptics: { stiffness: 200 }\n";
    put(file, text);
    FixtureEditor editor = editorOf(file);
    {
        const FileSizeLimit full(text.find("the disk"));
        CHECK(editor.save().find("not saved: " + file.string()) == 0);
    }
    CHECK(textOf(file) == text);
    CHECK(folder.files() == 1);
    CHECK(editor.save() == "0 fixtures saved to " + file.string());
    CHECK(editor.save() == "0 fixtures saved to " + file.string());
}

TEST_CASE("A scene that is a link stays one, and files next to it are left alone") {
    const ScratchFolder folder;
    const auto real = folder.path() / "real.yaml", link = folder.path() / "link.yaml";
    put(real, std::string("fixtures: []\n") + kRest);
    put(link.string() + ".new", "mine");
    std::filesystem::create_symlink("real.yaml", link);
    FixtureEditor editor = editorOf(link);
    editor.keepSettings({}, "");
    CHECK(editor.save() == "0 fixtures saved to " + link.string());
    CHECK(std::filesystem::is_symlink(link));
    CHECK(textOf(real).find("window: {") != std::string::npos);
    CHECK(textOf(link.string() + ".new") == "mine");
}

TEST_CASE("A scene file that is gone is not replaced by one with fixtures only") {
    const ScratchFolder folder;
    const auto file = folder.path() / "scene.yaml";
    put(file, std::string("fixtures: []\n") + kRest);
    FixtureEditor editor = editorOf(file);
    std::filesystem::remove(file);
    CHECK(editor.save().find("not saved: " + file.string()) == 0);
    CHECK(folder.files() == 0);
}
