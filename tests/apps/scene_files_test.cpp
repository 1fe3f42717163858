// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/scene_files.h"

#include "tests/apps/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Files in the folder of a scene are copied under their names, and others are listed") {
    const ScratchFolder home, elsewhere, copy;
    std::filesystem::create_directories(home.path() / "tools");
    put(home.path() / "tools/jaw.sph", "spheres");
    put(home.path() / "arm.urdf", "arm");
    put(elsewhere.path() / "path.csv", "path");
    Scene scene;
    scene.file = home.path() / "scene.yaml";
    scene.tool.file = home.path() / "tools/jaw.sph";
    scene.arm.emplace();
    scene.arm->urdf = home.path() / "arm.urdf";
    scene.hand.builtIn = false;
    scene.hand.path = (elsewhere.path() / "path.csv").string();
    const std::string left = copySceneFiles(scene, copy.path());
    CHECK(textOf(copy.path() / "tools/jaw.sph") == "spheres");
    CHECK(textOf(copy.path() / "arm.urdf") == "arm");
    CHECK(left == scene.hand.path);
    CHECK(copy.files() == 2);
    Scene plain; // a scene that names no files
    plain.file = scene.file;
    CHECK(copySceneFiles(plain, copy.path()).empty());
    CHECK(copy.files() == 2);
}
