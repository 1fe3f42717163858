// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/scene_files.h"

#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Files in the folder of a scene are copied under their names, and others are listed") {
    const ScratchFolder home, elsewhere, copy;
    std::filesystem::create_directories(home.path() / "tools");
    put(home.path() / "tools/jaw.sph", "spheres");
    put(home.path() / "arm.urdf", "<robot name='arm'><link name='base'/></robot>");
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
    CHECK(textOf(copy.path() / "arm.urdf") == textOf(home.path() / "arm.urdf"));
    CHECK(left == scene.hand.path);
    CHECK(copy.files() == 2);
    Scene plain; // a scene that names no files
    plain.file = scene.file;
    CHECK(copySceneFiles(plain, copy.path()).empty());
    CHECK(copy.files() == 2);
}

TEST_CASE(
    "The meshes of an arm are copied, also with arm.meshes, and folders of meshes elsewhere are listed") {
    const ScratchFolder home;
    const auto elsewhere = home.path() / "elsewhere/meshes";
    std::filesystem::create_directories(home.path() / "at/meshes");
    std::filesystem::create_directories(elsewhere);
    put(home.path() / "at/meshes/a.stl", "a");
    put(home.path() / "at/unused.stl", "unused");
    put(elsewhere / "b.stl", "b");
    const auto link = [](const std::string& name, const std::string& file) {
        return "<link name='" + name + "'><collision><geometry><mesh filename='" + file +
               "'/></geometry></collision></link>";
    };
    put(home.path() / "at/arm.urdf", "<robot name='arm'>" + link("base", "meshes/a.stl") + "</robot>");
    put(home.path() / "at/two.urdf",
        "<robot name='arm'>" + link("base", (elsewhere / "b.stl").string()) + "</robot>");
    Scene scene;
    scene.file = home.path() / "at/scene.yaml";
    scene.arm.emplace();
    for (const char* meshes : {"", "at", "at/meshes/.."}) {
        CAPTURE(meshes);
        const auto copy = home.path() / "at/copy"; // in the folder of the meshes
        scene.arm->urdf = home.path() / "at/arm.urdf";
        scene.arm->meshes = std::string(meshes).empty() ? "" : home.path() / meshes;
        CHECK(copySceneFiles(scene, copy) == "");
        CHECK(textOf(copy / "meshes/a.stl") == "a");
        CHECK_FALSE(std::filesystem::exists(copy / "unused.stl"));
        std::filesystem::remove_all(copy);
        scene.arm->urdf = home.path() / "at/two.urdf";
        CHECK(copySceneFiles(scene, copy) == elsewhere.string());
        std::filesystem::remove_all(copy);
    }
}

TEST_CASE("The files that an MJCF file includes are copied, those of included files too") {
    const ScratchFolder home, copy;
    std::filesystem::create_directories(home.path() / "parts");
    put(home.path() / "arm.xml", "<mujoco><include file='parts/body.xml'/></mujoco>");
    put(home.path() / "parts/body.xml", "<mujoco><include file='parts/more.xml'/></mujoco>");
    put(home.path() / "parts/more.xml",
        "<mujoco><worldbody><body name='a'><geom type='sphere' size='0.1'/></body></worldbody></mujoco>");
    Scene scene;
    scene.file = home.path() / "scene.yaml";
    scene.arm.emplace();
    scene.arm->urdf = home.path() / "arm.xml";
    CHECK(copySceneFiles(scene, copy.path()) == "");
    CHECK(std::filesystem::exists(copy.path() / "parts/body.xml"));
    CHECK(std::filesystem::exists(copy.path() / "parts/more.xml"));
}

TEST_CASE("A copy replaces no other file and follows no link; a file with the same bytes stays") {
    const ScratchFolder home, copy;
    home.write("jaws/jaw.sph", "spheres");
    Scene scene;
    scene.file = home.path() / "scene.yaml";
    scene.tool.file = home.path() / "jaws/jaw.sph";
    const auto refused = [&](const std::string& name) {
        for (const Copying how : {Copying::Check, Copying::Do}) {
            CHECK_THROWS_WITH_AS(copySceneFiles(scene, copy.path(), how),
                                 doctest::Contains((copy.path() / name).c_str()), BadInput);
        }
    };
    copySceneFiles(scene, copy.path(), Copying::Check);
    CHECK(copy.files() == 0);
    copy.write("jaws/jaw.sph", "another");
    refused("jaws/jaw.sph");
    CHECK(copy.read("jaws/jaw.sph") == "another");
    copy.write("jaws/jaw.sph", "spheres");
    CHECK_NOTHROW(copySceneFiles(scene, copy.path()));
    std::filesystem::remove(copy.path() / "jaws/jaw.sph");
    copy.write("mine", "precious");
    std::filesystem::create_symlink("../mine", copy.path() / "jaws/jaw.sph");
    refused("jaws/jaw.sph");
    CHECK(copy.read("mine") == "precious");
    std::filesystem::remove(copy.path() / "jaws/jaw.sph");
    std::filesystem::create_symlink(scene.tool.file, copy.path() / "jaws/jaw.sph");
    CHECK_NOTHROW(copySceneFiles(scene, copy.path())); // the file itself
    std::filesystem::remove_all(copy.path() / "jaws");
    std::filesystem::create_directory_symlink(home.path(), copy.path() / "jaws");
    refused("jaws");
    CHECK_FALSE(std::filesystem::exists(home.path() / "jaw.sph"));
}
