// SPDX-License-Identifier: Apache-2.0
// Where the meshes of an arm's URDF are looked for.
#include "engine/model/arm_model.h"

#include "engine/types/error.h"
#include "tests/model/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;

TEST_CASE("Meshes are found by URIs of Gazebo and with escaped characters") {
    const testing::ScratchFolder folder;
    std::filesystem::create_directories(folder / "my arm/meshes");
    const testing::ObjFile box(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    std::filesystem::copy_file(box.path(), folder / "my arm/meshes/link one.obj");
    std::filesystem::copy_file(box.path(), folder / "my arm/meshes/100%25.obj");
    for (const char* name :
         {"model://my%20arm/meshes/link%20one.obj", "package://other/meshes/link%20one.obj",
          "file://meshes/link%20one.obj", "meshes/link one.obj", "meshes/100%25.obj"}) {
        const auto file = folder / "my arm/arm.urdf";
        std::ofstream(file) << "<robot name='r'><link name='a'><collision><geometry><mesh filename='" << name
                            << "'/></geometry></collision></link></robot>";
        CHECK_MESSAGE(!loadArm(file).leaves.empty(), name);
    }
}

TEST_CASE("A mesh of a package that is not there is not taken from another package") {
    const testing::ScratchFolder folder;
    const testing::ObjFile box(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    const auto put = [&](const std::string& name) {
        std::filesystem::create_directories((folder / name).parent_path());
        std::filesystem::copy_file(box.path(), folder / name,
                                   std::filesystem::copy_options::overwrite_existing);
    };
    const auto notesOf = [&](const std::string& place, const std::vector<std::string>& meshes) {
        std::string shapes;
        for (const std::string& mesh : meshes) {
            shapes += "<collision><geometry><mesh filename='package://" + mesh + "'/></geometry></collision>";
        }
        std::ofstream(folder / place) << "<robot name='r'><link name='a'>" << shapes << "</link></robot>";
        try {
            return loadArm(folder / place).notes;
        } catch (const BadInput& e) {
            return std::vector<std::string>{e.what()};
        }
    };
    put("flat/meshes/base.obj");
    put("flat/meshes/finger.obj");
    put("own/arm/meshes/base.obj");
    put("own/arm/meshes/finger.obj");
    put("flat/grip/meshes/hand.obj");
    CHECK(notesOf("flat/r.urdf", {"arm/meshes/base.obj"}).empty());
    const auto same = notesOf("flat/r.urdf", {"arm/meshes/base.obj", "grip/meshes/base.obj"});
    REQUIRE(same.size() == 1);
    CHECK_MESSAGE(same[0].find("mesh 'package://arm/meshes/base.obj' not found; ") != std::string::npos,
                  same[0]);
    CHECK_MESSAGE(same[0].find("flat/meshes/base.obj (of package arm or grip)") != std::string::npos,
                  same[0]);
    const auto other = notesOf("flat/r.urdf", {"arm/meshes/base.obj", "grip/meshes/finger.obj"});
    REQUIRE(other.size() == 2);
    CHECK(
        other[0].find(
            "base.obj is taken for 'package://arm/meshes/base.obj'; its folder has not the package's name") !=
        std::string::npos);
    CHECK(notesOf("flat/r.urdf", {"arm/meshes/base.obj", "grip/meshes/hand.obj"}).size() ==
          1); // grip is there
    const auto own = notesOf("own/arm/r.urdf", {"arm/meshes/base.obj", "grip/meshes/finger.obj"});
    REQUIRE(own.size() == 1);
    CHECK_MESSAGE(own[0].find("mesh 'package://grip/meshes/finger.obj' not found; ") != std::string::npos,
                  own[0]);
    std::ofstream(folder / "flat/package.xml")
        << "<package><!-- <name>grip</name> --><name>arm</name></package>";
    CHECK(notesOf("flat/r.urdf", {"arm/meshes/base.obj", "grip/meshes/hand.obj"}).empty());
    CHECK(notesOf("flat/r.urdf", {"arm/meshes/base.obj", "grip/meshes/finger.obj"})[0].find("not found") !=
          std::string::npos);
}

TEST_CASE("A mesh is not taken from a folder whose package.xml names another package") {
    const testing::ScratchFolder folder;
    const testing::ObjFile box(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    std::filesystem::create_directories(folder / "cell/meshes");
    std::filesystem::create_directories(folder / "cell/urdf");
    std::filesystem::copy_file(box.path(), folder / "cell/meshes/base.obj");
    const auto faultWith = [&](const std::string& manifest, const std::string& more) {
        std::ofstream(folder / "cell/package.xml") << manifest;
        std::ofstream(folder / "cell/urdf/arm.urdf")
            << "<robot name='r'><link name='a'><collision><geometry><mesh filename='package://arm/meshes/"
               "base.obj'/></geometry></collision>"
            << more << "</link></robot>";
        return testing::refusalOf([&] { loadArm(folder / "cell/urdf/arm.urdf"); });
    };
    const std::string other = "<?xml version='1.0'?>\n<package format='3'>\n<name>\n cell </name></package>";
    const std::string relative =
        "<collision><geometry><mesh filename='../meshes/base.obj'/></geometry></collision>";
    for (const std::string& more : {std::string(), relative}) {
        const std::string fault = faultWith(other, more);
        CHECK_MESSAGE(fault.find("/cell/meshes/base.obj (of package cell)") != std::string::npos, fault);
    }
    CHECK(faultWith(other, "") != "");
    ArmOptions chosen;
    chosen.meshes = folder / "cell";
    const auto notes = loadArm(folder / "cell/urdf/arm.urdf", chosen).notes;
    CHECK(std::ranges::any_of(notes, [](const std::string& note) {
        return note.find("is taken for 'package://arm/meshes/base.obj'; of package cell") !=
               std::string::npos;
    }));
    CHECK(faultWith("<package><name> arm\n</name></package>", "") == "");
    CHECK(faultWith("<package/>", relative) == "");
}

TEST_CASE(
    "Meshes of a URDF made on Windows are found in spite of backslashes, and of capitals with one note") {
    const testing::ScratchFolder folder;
    const testing::ObjFile box(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    std::filesystem::create_directories(folder / "arm/meshes");
    for (const char* file : {"arm/meshes/a.obj", "arm/meshes/b.obj", "arm/b\\c.obj"}) {
        std::filesystem::copy_file(box.path(), folder / file);
    }
    const auto notesOf = [&](const std::vector<std::string>& meshes) {
        std::string shapes;
        for (const std::string& mesh : meshes) {
            shapes += "<collision><geometry><mesh filename='" + mesh + "'/></geometry></collision>";
        }
        std::ofstream(folder / "arm/r.urdf")
            << "<robot name='r'><link name='l'>" << shapes << "</link></robot>";
        return loadArm(folder / "arm/r.urdf").notes;
    };
    CHECK(notesOf({"package://arm\\meshes\\a.obj", "meshes\\b.obj", "b\\c.obj"}).empty());
    const auto notes =
        notesOf({"meshes/a.obj", "package://Arm/Meshes/A.OBJ", "meshes\\B.obj", "Meshes/A.obj"});
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].find(
              "link l: " + (folder / "arm/meshes/a.obj").string() +
              " is taken for 'package://Arm/Meshes/A.OBJ', which differs in capitals; meshes taken so: "
              "2") == 0);
    std::filesystem::copy_file(box.path(), folder / "arm/meshes/B.obj");
    CHECK(notesOf({"meshes/B.obj", "meshes/b.obj"}).empty());
    CHECK_THROWS_WITH_AS(notesOf({"meshes/b.OBJ"}), doctest::Contains("mesh 'meshes/b.OBJ' not found"),
                         BadInput);
}

TEST_CASE("An arm's meshes that are not closed are reported once") {
    const testing::ScratchFolder folder;
    TriangleMesh mesh = testing::boxMesh(dvec3(0.0), dvec3(0.1));
    const testing::ObjFile closed(mesh);
    mesh.triangles.pop_back();
    const testing::ObjFile open(mesh);
    const auto shape = [](const testing::ObjFile& file) {
        return "<collision><geometry><mesh filename='" + file.path().string() + "'/></geometry></collision>";
    };
    std::ofstream(folder / "r.urdf") << "<robot name='r'><link name='a'>" << shape(open) << shape(closed)
                                     << shape(open) << "</link></robot>";
    for (int start = 0; start < 2; ++start) { // the second from the cache
        const auto notes = loadArm(folder / "r.urdf").notes;
        const std::string expected =
            "meshes that are not closed and are covered at their surface only: 2, the first on link a";
        CHECK(std::any_of(notes.begin(), notes.end(),
                          [&](const std::string& note) { return note == expected; }));
    }
}

TEST_CASE("Any number of meshes outside the URDF's folder is reported once") {
    const testing::ScratchFolder folder;
    std::filesystem::create_directories(folder / "urdf");
    const testing::ObjFile one(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    std::filesystem::copy_file(one.path(), folder / "one.obj");
    std::filesystem::copy_file(one.path(), folder / "two.obj");
    std::filesystem::copy_file(one.path(), folder / "urdf/inside.obj");
    const auto shape = [](const std::string& name) {
        return "<collision><geometry><mesh filename='package://" + name + "'/></geometry></collision>";
    };
    const auto notes = [&](const std::string& shapes) {
        const auto file = folder / "urdf/arm.urdf";
        std::ofstream(file) << "<robot name='r'><link name='a'>" << shapes << "</link></robot>";
        return loadArm(file).notes;
    };
    std::filesystem::create_symlink("../one.obj", folder / "urdf/link.obj");
    CHECK(notes(shape("inside.obj")).empty());
    CHECK(notes(shape("link.obj")).size() == 1);
    const auto reported = notes(shape("two.obj") + shape("one.obj") + shape("inside.obj") + shape("one.obj"));
    REQUIRE(reported.size() == 1);
    CHECK(reported[0] == "meshes outside their search folder: 2, the first " + (folder / "one.obj").string());
}
