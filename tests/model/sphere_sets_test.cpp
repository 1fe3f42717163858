// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_sets.h"

#include "engine/types/error.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

using namespace fathom;

namespace {

std::string setRefusal(const std::string& kind, const std::string& text, const std::string& link = "") {
    const testing::ScratchFile file("set" + kind, text);
    return testing::refusalOf([&] { readSphereTree(file.path(), link); });
}

std::string ball(const std::string& centre, const std::string& radius) {
    return "<collision><origin xyz='" + centre + "'/><geometry><sphere radius='" + radius +
           "'/></geometry></collision>";
}

const std::string kRobot =
    "<robot name='r'><link name='a/hand'>" + ball("0.1 0 0", "0.02") + ball("0 0.2 0", "0.03") + "</link>";

} // namespace

TEST_CASE("A spherized URDF gives each link's spheres at their origins") {
    const testing::ScratchFile file("set.urdf", kRobot + "</robot>");
    const auto sets = readSpherizedUrdf(file.path());
    REQUIRE(sets.size() == 1);
    CHECK(sets[0].link == "a/hand");
    REQUIRE(sets[0].spheres.size() == 2);
    CHECK(sets[0].spheres[0].centre == dvec3(0.1, 0, 0));
    CHECK(sets[0].spheres[1].radius == 0.03);
    const SphereTree tree = readSphereTree(file.path());
    CHECK(validate(tree) == "");
    CHECK(tree.nodes[0].radius > 0.1);
}

TEST_CASE(
    "A shape that is no sphere rejects a spherized URDF, unless it belongs to a link that is not asked for") {
    const auto robot = [](const std::string& shape) {
        return "<robot name='r'><link name='a'>" + ball("0 0 0", "0.01") +
               "</link><link name='b'><collision><geometry>" + shape + "</geometry></collision>" +
               ball("0 0 1", "0.01") +
               "</link><joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint></robot>";
    };
    for (const auto& [shape, name] : {std::pair{"<box size='1 1 1'/>", "a box"},
                                      {"<cylinder radius='1' length='1'/>", "a cylinder"},
                                      {"<capsule radius='1' length='1'/>", "a capsule"},
                                      {"<mesh filename='a.stl'/>", "a mesh"}}) {
        for (const char* link : {"", "b"}) {
            const std::string refusal = setRefusal(".urdf", robot(shape), link);
            CHECK_MESSAGE(refusal.find(std::string("link b, collision 1: ") + name +
                                       " (allowed: spheres; ") != std::string::npos,
                          refusal);
        }
        CHECK(setRefusal(".urdf", robot(shape), "a") == "");
    }
}

TEST_CASE("cuRobo's YAML is read at the top and under its tables; disabled spheres are skipped") {
    const std::string spheres =
        "collision_spheres:\n  hand:\n    - {center: [0, 0, 0.1], radius: 0.02}\n"
        "    - {center: [0, 0, 0.2], radius: -10}\n  base: [{center: [1, 2, 3], radius: 0.5}]\n";
    std::string nested = "robot_cfg:\n  kinematics:\n";
    for (size_t at = 0, end = 0; at < spheres.size(); at = end + 1) {
        end = spheres.find('\n', at);
        nested += "    " + spheres.substr(at, end - at) + "\n";
    }
    for (const std::string& text : {spheres, nested}) {
        const testing::ScratchFile file("set.yml", text);
        const auto sets = readYamlSets(file.path());
        REQUIRE(sets.size() == 2);
        CHECK(sets[0].link == "hand");
        CHECK(sets[0].spheres.size() == 1);
        CHECK(sets[1].spheres[0].centre == dvec3(1, 2, 3));
        CHECK(readSphereTree(file.path(), "base").lastLevel()[0].radius == 0.5);
    }
    CHECK(setRefusal(".yaml", spheres).find("link: not named (allowed: hand, base)") != std::string::npos);
    CHECK(setRefusal(".yaml", spheres, "arm").find("link: 'arm' (allowed: hand, base)") != std::string::npos);
}

TEST_CASE("cuRobo's buffer, one number or one per link, is added to the radii") {
    const std::string spheres =
        "kinematics:\n  collision_spheres:\n    hand: [{center: [0, 0, 0], radius: 0.01}]\n"
        "    arm: [{center: [0, 0, 0], radius: 0.02}]\n    off: [{center: [0, 0, 0], radius: -1}]\n"
        "  collision_sphere_buffer: ";
    const auto radii = [&](const std::string& buffer) {
        const testing::ScratchFile file("set.yml", spheres + buffer);
        const auto sets = readYamlSets(file.path());
        REQUIRE(sets.size() == 2);
        return glm::dvec2(sets[0].spheres[0].radius, sets[1].spheres[0].radius);
    };
    CHECK(glm::distance(radii("0.005"), glm::dvec2(0.015, 0.025)) < 1e-12);
    CHECK(glm::distance(radii("{arm: 0.005, off: 0.1}"), glm::dvec2(0.01, 0.025)) < 1e-12);
    CHECK(glm::distance(radii("-0.005"), glm::dvec2(0.005, 0.015)) < 1e-12);
    CHECK(radii("") == glm::dvec2(0.01, 0.02));
    for (const char* buffer : {"{hnad: 0.05}", "[0.05]", "much", "{arm: much}"}) {
        CHECK_MESSAGE(setRefusal(".yml", spheres + buffer, "arm") != "", buffer);
    }
}

TEST_CASE(
    "An XRDF's buffer is one number, as cuRobo writes it, or one per link, and only spheres are geometry") {
    const auto text = [](const std::string& buffer, const std::string& more = "") {
        return "format: xrdf\ncollision: {geometry: g, buffer_distance: " + buffer + "}\ngeometry: {g: {" +
               more + "spheres: {hand: [{center: [0, 0, 0], radius: 0.01}]}}, other: {clone: g}}\n";
    };
    const auto radius = [&](const std::string& buffer) {
        const testing::ScratchFile file("set.xrdf", text(buffer));
        return readXrdf(file.path())[0].spheres[0].radius;
    };
    CHECK(radius("0.0") == 0.01);
    CHECK(radius("0.005") == doctest::Approx(0.015).epsilon(1e-12));
    CHECK(radius("{hand: 0.005}") == doctest::Approx(0.015).epsilon(1e-12));
    CHECK(radius("{}") == 0.01);
    CHECK(setRefusal(".xrdf", text("[0.005]")).find("collision.buffer_distance: a list") !=
          std::string::npos);
    CHECK(setRefusal(".xrdf", text("{hnad: 0.005}")).find("link 'hnad'") != std::string::npos);
    CHECK(setRefusal(".xrdf", text("0", "clone: other, "))
              .find("geometry.g: 'clone' (allowed: only spheres)") != std::string::npos);
}

TEST_CASE("A buffer for a link without spheres is no error, unless it is misspelt") {
    const auto text = [](const std::string& buffer) {
        return "format: xrdf\ncollision: {buffer_distance: {" + buffer +
               "}}\ngeometry: {g: {spheres: {wrist_1: [{center: [0, 0, 0], radius: 0.01}]}}}\n";
    };
    for (const char* buffer : {"wrist_1: 0.005, tool0: 0.02", "wrist_1: 0.005, wrist_2: 0.02"}) {
        const testing::ScratchFile file("set.xrdf", text(buffer));
        CHECK(readXrdf(file.path()).at(0).spheres[0].radius == doctest::Approx(0.015));
    }
    for (const char* other : {"wrist_2: 0.02", "hand: 0.02"}) {
        const testing::ScratchFile file("set.xrdf", text(other));
        CHECK(readXrdf(file.path()).at(0).spheres[0].radius == doctest::Approx(0.01));
    }
    CHECK(setRefusal(".xrdf", text("wrst_1: 0.02")).find("link 'wrst_1' (allowed: wrist_1)") !=
          std::string::npos);
}

TEST_CASE("An XRDF of version 2 names the geometry and buffer of the world, and links may have no spheres") {
    const std::string two = "geometry:\n  other: {spheres: {hand: [{center: [0, 0, 0], radius: 0.5}]}}\n"
                            "  g: {spheres: {hand: [{center: [0, 0, 0], radius: 0.01}], held: }}\n";
    const testing::ScratchFile file("set.xrdf",
                                    "format: xrdf\nformat_version: 2.0\nworld_collision: {geometry: g, "
                                    "buffer_distance: {hand: 0.005}}\nself_collision: {geometry: other}\n" +
                                        two);
    const auto sets = readXrdf(file.path());
    REQUIRE(sets.size() == 1);
    CHECK(sets[0].spheres[0].radius == doctest::Approx(0.015).epsilon(1e-12));
    CHECK(setRefusal(".xrdf", "format: xrdf\nformat_version: 2.0\nworld_collision: {}\n" + two)
              .find("world_collision.geometry: missing") != std::string::npos);
    const testing::ScratchFile robo("set.yml",
                                    "collision_spheres: {hand: [{center: [0, 0, 0], radius: 0.01}], "
                                    "attached_object: null}\n");
    CHECK(readYamlSets(robo.path()).size() == 1);
}

TEST_CASE(
    "cuRobo's spheres are also read as Lula's list and as JSON; the name of another file is passed on") {
    const testing::ScratchFile lula(
        "set.yaml", "api_version: 1.0\ncollision_spheres:\n  - hand:\n    - \"center\": [0, 0, 0.05]\n"
                    "      \"radius\": 0.045\n  - arm:\n    - {center: [0, 0, 0.1], radius: 0.05}\n");
    const auto sets = readYamlSets(lula.path());
    REQUIRE(sets.size() == 2);
    CHECK(sets[0].link == "hand");
    CHECK(sets[0].spheres[0].centre == dvec3(0, 0, 0.05));
    CHECK(sets[1].spheres[0].radius == 0.05);
    CHECK(setRefusal(".yaml", "collision_spheres: [5]").find("line 1: no table") != std::string::npos);
    CHECK(setRefusal(".yaml", "robot_cfg: {kinematics: {collision_spheres: spheres/franka_mesh.yml}}")
              .find("collision_spheres: the name of a file, spheres/franka_mesh.yml (allowed: {LINK: ") !=
          std::string::npos);
    const std::string json = R"({"collision_spheres": {"hand": [{"center": [0, 0, 0], "radius": 0.01}]}})";
    CHECK(readFoam(testing::ScratchFile("set.json", json).path())[0].spheres[0].radius == 0.01);
}

TEST_CASE("A repeated key of a set, and a second document, are rejected and not dropped") {
    const std::string one = "[{center: [0, 0, 0], radius: 1}]";
    for (const std::string& text :
         {"collision_spheres: {hand: " + one + ", hand: " + one + "}",
          "collision_spheres: {hand: " + one + "}\ncollision_spheres: {arm: " + one + "}",
          std::string("collision_spheres: {hand: [{center: [0, 0, 0], radius: 1, radius: 2}]}"),
          "robot_cfg: {kinematics: {collision_spheres: {hand: " + one + "}}, kinematics: {}}",
          "format: xrdf\ngeometry: {g: {spheres: {hand: " + one + ", hand: " + one + "}}}",
          "format: xrdf\ncollision: {geometry: g}\ngeometry: {g: {spheres: {hand: " + one +
              "}}, g: {spheres: {arm: " + one + "}}}",
          "format: xrdf\ncollision: {buffer_distance: {hand: 1, hand: 2}}\ngeometry: {g: {spheres: {hand: " +
              one + "}}}"}) {
        const std::string refusal = setRefusal(".yaml", text, "hand");
        CHECK_MESSAGE(refusal.find("given twice (allowed: each key once)") != std::string::npos, text,
                      refusal);
    }
    CHECK(setRefusal(".yaml",
                     "collision_spheres: {hand: " + one + "}\n---\ncollision_spheres: {arm: " + one + "}")
              .find("line 2: more than a YAML document") != std::string::npos);
    CHECK(setRefusal(".json", "{\"a::b\": {\"spheres\": []}, \"a::b\": {\"spheres\": []}}")
              .find("given twice") != std::string::npos);
    CHECK(setRefusal(".yaml", "---\ncollision_spheres: {hand: " + one + "}\n...\n") == "");
}

TEST_CASE("A damaged set is rejected with the place of the error") {
    CHECK(setRefusal(".urdf", "").find("file: empty") != std::string::npos);
    CHECK(setRefusal(".urdf", "<robot").find("robot: ") != std::string::npos);
    CHECK(setRefusal(".urdf", "<robot name='r'><link name='x'/></robot>").find("spheres: none") !=
          std::string::npos);
    CHECK(setRefusal(".urdf", "<robot name='r'><link name='x'>" + ball("0 0 0", "-1") + "</link></robot>") !=
          "");
    CHECK(setRefusal(".yaml", "collision_spheres: {a: [{center: [0, 0], radius: 1}]}")
              .find("line 1: not a sphere") != std::string::npos);
    CHECK(setRefusal(".yaml", "a: \"\\\x02\"\n").find_first_of("\n\x02") ==
          std::string::npos); // it quotes the input
    CHECK(setRefusal(".yaml", "a: \"\\\x02\"\n").find("escape") != std::string::npos);
    CHECK(setRefusal(".yaml", "collision_spheres:\n  a:\n    - {center: [0, 0, .nan], radius: 1}")
              .find("line 3") != std::string::npos);
    CHECK(setRefusal(".yaml", "collision_spheres: {a: [{center: [0, 0, 0], radius: !inches 1}]}")
              .find("line 1: tag '!inches' (allowed: values without a tag") != std::string::npos);
    CHECK(setRefusal(".yaml", "other: 1").find("collision_spheres: missing") != std::string::npos);
    CHECK(setRefusal(".yaml", "a: [").find("line") != std::string::npos);
    CHECK(setRefusal(".txt", "x").find("kind of file: '.txt'") != std::string::npos);
}

TEST_CASE("A link of a sphere tree, which has none, is rejected") {
    CHECK(setRefusal(".sph", "1 1\n0 0 0 0.01\n") == "");
    CHECK(setRefusal(".sph", "1 1\n0 0 0 0.01\n", "foo")
              .find("link: foo (allowed: none: a .sph file has no links)") != std::string::npos);
}

TEST_CASE("A set whose tables or lists reference themselves or each other is rejected") {
    CHECK(setRefusal(".yaml", "&a {robot_cfg: {kinematics: *a}}").find("collision_spheres: missing") !=
          std::string::npos);
    CHECK(setRefusal(".yaml", "collision_spheres: &a {hand: &b [*b], arm: *a}").find("not a sphere") !=
          std::string::npos);
    std::string many = "collision_spheres:\n  base: &l [&s {center: [0, 0, 0], radius: 1}";
    for (int i = 0; i < 1000; ++i) {
        many += ", *s";
    }
    many += "]\n";
    for (int i = 0; i < 1000; ++i) {
        many += "  l" + std::to_string(i) + ": *l\n";
    }
    CHECK(setRefusal(".yaml", many).find("collision_spheres: over 65536 (allowed: 65536 spheres at most)") !=
          std::string::npos);
}

TEST_CASE("An oversized set is rejected before it takes memory, and quoted only in part") {
    const std::string set = "collision_spheres: {hand: [{center: [0, 0, 0], radius: 1}]}\n#";
    CHECK(setRefusal(".yaml", set + std::string(900'000, 'x') + "\n") == "");
    const std::string large = setRefusal(".yaml", set + std::string(1'100'000, 'x') + "\n");
    CHECK_MESSAGE(large.find("file: " + std::to_string(set.size() + 1'100'001) +
                             " bytes (allowed: a readable YAML file of at most 1 MiB)") != std::string::npos,
                  large);
    std::string names = "collision_spheres:\n";
    for (int i = 100; i < 200; ++i) { // a key of YAML has 1024 characters at most
        names += "  " + std::string(900, 'x') + std::to_string(i) + ": [{center: [0, 0, 0], radius: 1}]\n";
    }
    const std::string word(500'000, 'x');
    for (const std::string& text :
         {names, "collision_spheres: {hand: [{center: [0, 0, " + word + "], radius: 1}]}"}) {
        const std::string refusal = setRefusal(".yaml", text);
        CHECK(refusal != "");
        CHECK(refusal.size() < 1500);
    }
}

TEST_CASE("A pipe instead of spheres or an arm is rejected without waiting") {
    for (const char* kind : {".yaml", ".urdf", ".sph"}) {
        const testing::ScratchFile file(std::string("set") + kind);
        std::filesystem::remove(file.path());
        REQUIRE(::mkfifo(file.path().c_str(), 0600) == 0);
        CHECK_THROWS_WITH_AS(readSphereTree(file.path()), doctest::Contains("file: a pipe or device"),
                             BadInput);
    }
}

TEST_CASE("The sphere sets that foam made of a real arm are read, with a valid tree per link") {
    const std::filesystem::path file =
        "../shared/data/meshes/foam_spherized_MIT/smaller_panda_spherized.urdf";
    if (!std::filesystem::exists(file)) {
        MESSAGE("SKIPPED: no such file: " << file);
        return;
    }
    size_t spheres = 0;
    for (const LinkSpheres& set : readSpherizedUrdf(file)) {
        CHECK(validate(readSphereTree(file, set.link)) == "");
        spheres += set.spheres.size();
    }
    CHECK(spheres > 30);
}
