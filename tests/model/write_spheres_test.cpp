// SPDX-License-Identifier: Apache-2.0
// Sphere sets in the formats of other programs: written, and read back.
#include "engine/model/write_spheres.h"

#include "engine/model/cover_urdf.h"
#include "engine/model/sph_file.h"
#include "tests/model/urdf_text.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>
#include <sstream>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::vector<LinkSpheres> kSets{
    {"arm/a", {{{0.1, -1.0 / 3.0, 1e-7}, 0.02}, {{0.0, 0.0, 0.3}, 1.0 / 7.0}}},
    {"hand \"left\"", {{{1.0, 2.0, 3.0}, 0.5}}}};

bool same(const std::vector<LinkSpheres>& a, const std::vector<LinkSpheres>& b) {
    bool equal = a.size() == b.size();
    for (size_t i = 0; equal && i < a.size(); ++i) {
        equal = a[i].link == b[i].link && a[i].spheres.size() == b[i].spheres.size();
        for (size_t k = 0; equal && k < a[i].spheres.size(); ++k) {
            equal = a[i].spheres[k].centre == b[i].spheres[k].centre &&
                    a[i].spheres[k].radius == b[i].spheres[k].radius;
        }
    }
    return equal;
}

std::string refusal(const std::string& name, const std::string& text) {
    const ScratchFile file(name, text);
    return refusalOf([&] { readSets(file.path()); });
}

const std::string kXrdf = "format: xrdf\nformat_version: 1.0\n";

} // namespace

TEST_CASE("Sets written as cuRobo YAML, XRDF, foam JSON and URDF are read back bit by bit") {
    CHECK(same(readSets(ScratchFile("a.yaml", curoboText(kSets)).path()), kSets));
    CHECK(same(readSets(ScratchFile("a.xrdf", xrdfText(kSets)).path()), kSets));
    CHECK(same(readSets(ScratchFile("b.yaml", xrdfText(kSets)).path()), kSets)); // by its format
    CHECK(same(readSets(ScratchFile("a.json", foamText(kSets)).path()), kSets));
    for (const LinkSpheres& set : kSets) {
        CHECK(same(readSets(ScratchFile("a.urdf", spherizedText(set)).path()), {set}));
    }
    const ScratchFile tree("t.sph", "");
    writeSph(buildSphereTree(kSets[0].spheres), tree.path());
    const auto leaves = readSets(tree.path());
    REQUIRE(leaves.size() == 1);
    CHECK(leaves[0].spheres.size() == 2);
}

TEST_CASE("XRDF uses the geometry that collisions name, with its buffer distances") {
    const std::string two =
        kXrdf +
        "collision: {geometry: g, buffer_distance: {a: 0.01}}\n"
        "geometry:\n  other: {spheres: {a: [{center: [9, 9, 9], radius: 1}]}}\n"
        "  g: {spheres: {a: [{center: [0, 0, 1], radius: 0.02}], b: [{center: [0, 0, 0], radius: 1}]}}\n";
    const auto sets = readSets(ScratchFile("two.xrdf", two).path());
    REQUIRE(sets.size() == 2);
    CHECK(sets[0].spheres[0].centre == dvec3(0, 0, 1));
    CHECK(sets[0].spheres[0].radius == doctest::Approx(0.03));
    CHECK(sets[1].spheres[0].radius == 1.0);
}

TEST_CASE("Spheres of radius 0 or below grow by the buffer, and have 1 mm where nothing is left of them") {
    const auto radii = [](const std::string& buffer) {
        const ScratchFile file("set.yml", "collision_spheres: {a: [{center: [0, 0, 0], radius: 0}, "
                                          "{center: [0, 0, 1], radius: -0.5}, {center: [0, 0, 2], "
                                          "radius: 0.02}]}\ncollision_sphere_buffer: " +
                                              buffer);
        std::vector<double> all;
        const std::vector<LinkSpheres> sets = readYamlSets(file.path());
        for (const Sphere& s : sets.at(0).spheres) {
            all.push_back(s.radius);
        }
        return all;
    };
    CHECK(radii("0.01") == std::vector<double>{0.01, 1e-3, 0.03});
    CHECK(radii("-0.03") == std::vector<double>{1e-3, 1e-3, 1e-3});
    CHECK(radii("-0.6") == std::vector<double>{1e-3, 1e-3}); // -1.1 disables
}

TEST_CASE("A damaged XRDF or foam file is rejected with the place of the error") {
    CHECK(refusal("a.xrdf", kXrdf).find("geometry: missing") != std::string::npos);
    CHECK(refusal("a.xrdf", kXrdf + "geometry: {a: {spheres: {}}, b: {spheres: {}}}")
              .find("collision.geometry: missing (allowed: the name of one of several") != std::string::npos);
    CHECK(refusal("a.xrdf", kXrdf + "collision: {geometry: g}\ngeometry: {h: 1}")
              .find("geometry.g.spheres: missing") != std::string::npos);
    CHECK(refusal("a.xrdf", kXrdf + "geometry: {g: {spheres: {a: [{center: [0, 0], radius: 1}]}}}")
              .find("line 3: not a sphere") != std::string::npos);
    CHECK(refusal("a.xrdf", kXrdf + "geometry: {g: {spheres: {a: 5}}}").find("link a: not a list") !=
          std::string::npos);
    CHECK(refusal("a.xrdf", kXrdf + "geometry: &g {g: *g}").find("geometry.g.spheres") != std::string::npos);
    const std::string spheres = "geometry: {g: {spheres: {hand: [{center: [0, 0, 0], radius: 1}]}}}\n";
    CHECK(refusal("a.xrdf", kXrdf + spheres + "collision: {buffer_distance: {hnad: 0.05}}")
              .find("collision.buffer_distance: link 'hnad' (allowed: hand)") != std::string::npos);
    CHECK(refusal("a.json", "[").find("line") != std::string::npos);
    CHECK(refusal("a.json", "5").find("spheres: missing") != std::string::npos);
    CHECK(refusal("a.json", "{\"a\": {\"spheres\": [{\"center\": [0, 0, 0], \"radius\": 1}]}}")
              .find("not a sphere (allowed: {origin: [x, y, z], radius: r})") != std::string::npos);
}

TEST_CASE(
    "foam's output for one mesh belongs to a link named as the file, and of several levels the last counts") {
    const auto sets =
        readSets(ScratchFile("foot.json", "[{\"spheres\": [{\"origin\": [0, 0, 0], \"radius\": 9}]},"
                                          " {\"spheres\": [{\"origin\": [0, 0, 1], \"radius\": 0.1}]}]")
                     .path());
    REQUIRE(sets.size() == 1);
    CHECK(sets[0].link.ends_with("foot"));
    CHECK(sets[0].spheres[0].radius == 0.1);
}

TEST_CASE("A whole URDF becomes a spherized one: all else stays, and its spheres contain the shapes") {
    const std::string urdf =
        "<?xml version='1.0'?>\n<robot name='r'>\n<!-- <link name='no'><collision/></link> -->\n"
        "  <link name='a'><visual><geometry><box size='1 1 1'/></geometry></visual>"
        "<collision><origin xyz='0 0 0.5'/><geometry><box size='0.2 0.1 "
        "0.1'/></geometry></collision></link>\n"
        "  <link name='b'/>\n" +
        jointText("j", "revolute", "a", "b", "0 0 1", "0 0 1") + "\n</robot>\n";
    const ScratchFile file("robot.urdf", urdf);
    const UrdfCover cover = coverUrdf(file.path(), {}, 16, false);
    REQUIRE(cover.links.size() == 1);
    const std::string text = spherizedText(urdf, cover.links);
    CHECK(text.find("<!-- <link name='no'><collision/></link> -->") != std::string::npos);
    CHECK(text.find("<visual><geometry><box size='1 1 1'/></geometry></visual>") != std::string::npos);
    CHECK(text.find("0.2 0.1 0.1") == std::string::npos);
    const ScratchFile spherized("spherized.urdf", text);
    CHECK(same(readSets(spherized.path()), cover.links));
    CHECK(loadArm(spherized.path()).count() == 1);
    for (const double x : {-0.1, 0.1}) {
        CHECK(std::any_of(cover.links[0].spheres.begin(), cover.links[0].spheres.end(), [&](const Sphere& s) {
            return glm::distance(s.centre, dvec3(x, 0.05, 0.55)) <= s.radius + 1e-9;
        }));
    }
}

TEST_CASE("Only collisions of links become spheres; a name of one, which a contact sensor refers to, stays") {
    const std::string others =
        "<gazebo reference='a'><sensor><contact><collision>bumper</collision></contact></sensor></gazebo>\n"
        "<gazebo><plugin><link name='a'><collision>keep me</collision></link></plugin></gazebo>";
    const std::string urdf = "<robot name='r'><link name='a'><collision name='bumper'><geometry><box "
                             "size='0.1 0.1 0.1'/></geometry></collision>"
                             "<collision><geometry><sphere radius='0.1'/></geometry></collision></link>" +
                             others + "</robot>";
    const std::string text = spherizedText(urdf, std::vector<LinkSpheres>{{"a", kSets[0].spheres}});
    CHECK(text.find(others) != std::string::npos);
    CHECK(text.find("box") == std::string::npos);
    CHECK(text.find("<collision name=\"bumper\"><origin") != std::string::npos);
    CHECK(text.find("<collision name=\"bumper_1\"><origin") != std::string::npos);
    CHECK(same(readSets(ScratchFile("sensor.urdf", text).path()), {{"a", kSets[0].spheres}}));
}

TEST_CASE("A text without the link of a set is rejected, not written without its spheres") {
    for (const char* text : {"<mujoco><worldbody><body name='a'/></worldbody></mujoco>",
                             "<robot name='r'><link name='b'></link></robot>"}) {
        CHECK_THROWS_WITH_AS(spherizedText(text, std::vector<LinkSpheres>{{"a", kSets[0].spheres}}),
                             doctest::Contains("link a: has spheres, but is not in the text"), BadInput);
    }
}

TEST_CASE("Capsules are covered, and those of a negative size or of none are rejected") {
    const ArmModel arm = loadUrdf("<link name='a'><collision><geometry><capsule radius='0.05' length='0.3'/>"
                                  "</geometry></collision></link>");
    const auto inside = [&](const dvec3& p) {
        return std::any_of(arm.leaves.begin(), arm.leaves.end(), [&](const ArmLeaf& leaf) {
            return glm::distance(leaf.sphere.centre, p) <= leaf.sphere.radius + 1e-9;
        });
    };
    for (int k = 0; k <= 100; ++k) {
        CHECK(inside({0.05 * std::cos(k), 0.05 * std::sin(k), -0.15 + 0.003 * k}));
    }
    CHECK(inside({0, 0, 0.2}));
    CHECK_FALSE(inside({0, 0, 0.201}));
    CHECK_FALSE(inside({0.056, 0, 0.05}));
    for (const char* sizes :
         {"radius='0.05' length='-1'", "radius='-1' length='1'", "radius='x' length='1'"}) {
        CHECK(urdfRefusal(std::string("<link name='a'><collision><geometry><capsule ") + sizes +
                          "/></geometry></collision></link>")
                  .find("link a: a shape with a negative size") != std::string::npos);
    }
}

TEST_CASE("A xacro file is rejected with a command that expands it into another file; a comment is none") {
    const std::string refusal = urdfRefusal("<xacro:include filename='a'/>"),
                      command = "expand it with: xacro ";
    CHECK(refusal.find("robot: a xacro file (allowed: a URDF; ") != std::string::npos);
    REQUIRE(refusal.find(command) != std::string::npos);
    std::istringstream words(refusal.substr(refusal.find(command) + command.size()));
    std::string from, to, into;
    words >> from >> to >> into;
    CHECK(to == ">");
    CHECK(from + ")" != into);
    CHECK(into.ends_with(".urdf)"));
    CHECK(urdfRefusal("<!-- <xacro:include filename='a'/> -->" + ballLink("a")) == "");
}
