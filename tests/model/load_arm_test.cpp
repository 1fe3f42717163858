// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_model.h"

#include "tests/model/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/sanitized.h"
#include "tests/support/scratch_folder.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

const std::string kBall =
    "<collision><origin xyz='0.1 0 0'/><geometry><sphere radius='0.05'/></geometry></collision>";
const std::string kLimit = "<limit effort='1' lower='-1' upper='2' velocity='0.5'/>";

std::string jointOf(const std::string& name, const std::string& type, const std::string& parent,
                    const std::string& child, const std::string& more = kLimit) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
           child + "'/><origin xyz='0.3 0 0' rpy='0 0 1.5707963267948966'/><axis xyz='0 0 2'/>" + more +
           "</joint>";
}

// base - fixed - arm/a - revolute - arm/b - prismatic - tip, and a finger off the chain.
const std::string kArm =
    "<robot name='r'><link name='base'>" + kBall + "</link><link name='arm/a'>" + kBall +
    "</link><link name='arm/b'>" + kBall + "</link><link name='tip'/><link name='finger'>" + kBall +
    "</link>" + jointOf("f", "fixed", "base", "arm/a", "") + jointOf("turn", "revolute", "arm/a", "arm/b") +
    jointOf("slide", "prismatic", "arm/b", "tip") + jointOf("jaw", "revolute", "arm/b", "finger");

ArmModel load(const std::string& text, const ArmOptions& options = {}) {
    return loadArm(testing::ScratchFile("arm.urdf", text).path(), options);
}

std::string armRefusal(const std::string& text, const ArmOptions& options = {}) {
    return testing::refusalOf([&] { load(text, options); });
}

} // namespace

TEST_CASE(
    "A URDF gives the chain to the tip with fixed joints merged, and every link's spheres with their joint") {
    ArmOptions options;
    options.tip = "tip";
    const ArmModel arm = load(kArm + "</robot>", options);
    REQUIRE(arm.count() == 2);
    CHECK(arm.joints[0].name == "turn");
    CHECK(arm.joints[0].axis == dvec3(0, 0, 1));
    CHECK(arm.joints[0].lower == -1.0);
    CHECK(arm.joints[0].speed == 0.5);
    CHECK(arm.joints[1].slides);
    REQUIRE(arm.leaves.size() == 4);
    CHECK(arm.links == std::vector<std::string>{"base", "arm/a", "arm/b", "finger"});
    CHECK(arm.leaves[0].joint == 0);
    CHECK(arm.leaves[1].joint == 0);
    CHECK(arm.leaves[2].joint == 1);
    CHECK(arm.leaves[3].joint == 1); // the jaw is off the chain

    // By hand: x forward 0.3, a quarter turn, y forward 0.3, a quarter turn and q; then 0.3, and along z by
    // q.
    ArmFrames frames;
    arm.place({0.0, 0.2}, Pose{}, frames);
    CHECK(glm::distance(arm.centre(frames, 0), dvec3(0.1, 0, 0)) < 1e-9);
    CHECK(glm::distance(arm.centre(frames, 1), dvec3(0.3, 0.1, 0)) < 1e-9);
    CHECK(glm::distance(arm.centre(frames, 2), dvec3(0.2, 0.3, 0)) < 1e-9);
    CHECK(glm::distance(arm.tip(frames).position, dvec3(0.0, 0.3, 0.2)) < 1e-9);
    arm.place({1.5707963267948966, 0.0}, Pose{}, frames);
    CHECK(glm::distance(arm.tip(frames).position, dvec3(0.3, 0.0, 0.0)) < 1e-9);
}

TEST_CASE("Boxes and cylinders become spheres that contain their corners and rims") {
    const std::string shapes =
        "<robot name='r'><link name='base'><collision><geometry><box size='0.2 0.1 0.06'/>"
        "</geometry></collision></link><link name='l'><collision><geometry>"
        "<cylinder radius='0.05' length='0.3'/></geometry></collision></link>" +
        jointOf("j", "continuous", "base", "l", "") + "</robot>";
    const ArmModel arm = load(shapes);
    CHECK(std::isinf(arm.joints[0].upper));
    const auto held = [&](const dvec3& p, uint32_t link) {
        for (const ArmLeaf& leaf : arm.leaves) {
            if (leaf.link == link && glm::distance(leaf.sphere.centre, p) <= leaf.sphere.radius + 1e-9) {
                return true;
            }
        }
        return false;
    };
    for (int k = 0; k < 8; ++k) {
        CHECK(held({k & 1 ? 0.1 : -0.1, k & 2 ? 0.05 : -0.05, k & 4 ? 0.03 : -0.03}, 0));
    }
    for (int k = 0; k < 100; ++k) {
        CHECK(held({0.05 * std::cos(0.7 * k), 0.05 * std::sin(0.7 * k), k % 2 == 0 ? 0.15 : -0.15}, 1));
    }
    CHECK(arm.leaves.size() <= 48);
}

TEST_CASE("An unusable arm is rejected with the joint or link and the reason") {
    ArmOptions options;
    options.tip = "nowhere";
    CHECK(armRefusal(kArm + "</robot>", options).find("link: 'nowhere' (allowed: ") != std::string::npos);
    options = {};
    options.base = "arm/b";
    options.tip = "base";
    CHECK(armRefusal(kArm + "</robot>", options).find("tip: 'base'") != std::string::npos);
    const std::string two = "<robot name='r'><link name='a'>" + kBall + "</link><link name='b'/>";
    options = {};
    options.tip = "b";
    CHECK(armRefusal(two + jointOf("j", "floating", "a", "b") + "</robot>", options)
              .find("joint j: planar, floating or a ball") != std::string::npos);
    CHECK(armRefusal(
              two +
              jointOf("j", "prismatic", "a", "b", "<limit effort='1' lower='2' upper='1' velocity='1'/>") +
              "</robot>")
              .find("joint j: lower 2, upper 1 (allowed: lower <= upper)") != std::string::npos);
    CHECK(armRefusal(two + "<link name='c'/>" + jointOf("j", "fixed", "a", "b") +
                     jointOf("k", "fixed", "c", "c") + "</robot>")
              .find("link c: in a loop of joints (allowed: a tree of links below one root)") !=
          std::string::npos);
    std::string many = "<robot name='r'><link name='l0'>" + kBall + "</link>";
    for (int k = 0; k < 13; ++k) {
        const std::string number = std::to_string(k);
        std::string a("l"), b("l"), name("j");
        a += number;
        b += std::to_string(k + 1);
        name += number;
        many += "<link name='" + b + "'/>" + jointOf(name, "revolute", a, b);
    }
    CHECK(armRefusal(many + "</robot>")
              .find("joint j12: one more moving joint (allowed: 12 at most from base to "
                    "tip; arm.locked holds joints") != std::string::npos);
    options = {};
    options.locked = {{"j3", 0.5}};
    CHECK(load(many + "</robot>", options).count() == 12);
    CHECK(armRefusal("<robot name='r'><link name='a'/></robot>").find("collision: no shapes") !=
          std::string::npos);
}

TEST_CASE("A URDF that would overflow its reader's stack is rejected: deeply nested elements or links") {
    constexpr int kDeep = 50000;
    std::string nested = "<robot name='r'>";
    for (int i = 0; i < kDeep; ++i) {
        nested += "<a>";
    }
    std::string chain = "<robot name='r'><link name='l0000000'/>"; // the root is the last in order of names
    for (int i = 1; i < kDeep; ++i) {
        const auto name = [](int k) {
            const std::string digits = std::to_string(k);
            return "l" + std::string(7 - digits.size(), '0') + digits;
        };
        chain += "<link name='" + name(i) + "'/>" + jointOf("j" + name(i), "fixed", name(i), name(i - 1));
    }
    const std::string refusal = armRefusal(nested);
    CHECK_MESSAGE((refusal.find("robot: breaks the URDF reader") != std::string::npos ||
                   refusal.find("XML_ELEMENT_DEPTH_EXCEEDED") != std::string::npos), // newer TinyXML-2
                  refusal);
    const std::string links = armRefusal(chain + "</robot>"); // a larger stack can survive them
    CHECK_MESSAGE((links.find("robot: 50000 links (allowed: 1000 at most)") != std::string::npos ||
                   links.find("robot: breaks the URDF reader") != std::string::npos),
                  links);
}

TEST_CASE("Real arms with four joints are read, also with slashes in the names") {
    const std::filesystem::path file = "../shared/data/urdf/oberon4/oberon4.urdf";
    if (!std::filesystem::exists(file)) {
        MESSAGE("SKIPPED: no such file: " << file);
        return;
    }
    if (kSanitized) {
        MESSAGE("SKIPPED: takes long under a sanitizer; the jaw's case reads such meshes there");
        return;
    }
    const ArmModel arm = loadArm(file);
    MESSAGE("oberon4: " << arm.count() << " joints, " << arm.leaves.size() << " leaves, " << arm.links.size()
                        << " links");
    CHECK(arm.count() >= 4);
    CHECK(arm.links[0] == "oberon4/base");
    CHECK(arm.leaves.size() > 50);
}

TEST_CASE("A URDF's mesh is scaled by three factors, and a factor of 0 is rejected") {
    const testing::ObjFile box(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    const auto text = [&](const std::string& scale) {
        return "<robot name='r'><link name='a'><collision><geometry><mesh filename='file://" +
               box.path().string() + "' scale='" + scale + "'/></geometry></collision></link></robot>";
    };
    const ArmModel arm = load(text("1 2 -4"));
    dvec3 high(-1.0);
    for (const ArmLeaf& leaf : arm.leaves) {
        high = glm::max(high, leaf.sphere.centre + leaf.sphere.radius);
    }
    CHECK(high.x > 0.05);
    CHECK(high.x < 0.09);
    CHECK(high.y > 0.10);
    CHECK(high.y < 0.14);
    CHECK(high.z > 0.20);
    CHECK(high.z < 0.24);
    CHECK(armRefusal(text("1 0 1")).find("link a: a mesh scale that is 0") != std::string::npos);
    const std::string large = armRefusal(text("1000 1000 1000"));
    INFO(large);
    CHECK(large.find(".urdf: link a: " + box.path().string() + ": size: 100 m") != std::string::npos);
    CHECK(large.find("<mesh scale=") != std::string::npos);
    CHECK(large.find("--scale") == std::string::npos);
}

TEST_CASE("Parts of an arm's files without leaves are reported in one line each") {
    TriangleMesh mesh = testing::boxMesh(dvec3(0.0), dvec3(0.1));
    testing::addBox(mesh, {4.0, 0.0, 0.0}, dvec3(0.01));
    const testing::ScratchFolder folder;
    const auto meshLink = [&](const std::string& name, const TriangleMesh& shape) {
        std::filesystem::copy_file(testing::ObjFile(shape).path(), folder / (name + ".obj"));
        return "<link name='" + name + "'><collision><geometry><mesh filename='" + name +
               ".obj'/></geometry></collision></link>";
    };
    const std::string seen = "<visual><geometry><sphere radius='0.1'/></geometry></visual>";
    folder.write("arm.urdf", "<robot name='r'>" + meshLink("a", mesh) +
                                 meshLink("b", testing::boxMesh(dvec3(0.0), {2.5, 0.2, 0.2})) +
                                 "<link name='c'>" + seen + "</link><link name='frame'/>" +
                                 jointOf("ab", "revolute", "a", "b") + jointOf("bc", "revolute", "b", "c") +
                                 jointOf("cf", "fixed", "c", "frame", "") + "</robot>");
    const ArmModel arm = loadArm(folder / "arm.urdf");
    REQUIRE(arm.notes.size() == 3);
    CHECK(arm.notes[0] == "link c has no collision shape and can enter regions");
    CHECK(arm.notes[1].find("link a: " + (folder / "a.obj").string() +
                            ": stray geometry is dropped: 1 pieces up to") == 0);
    CHECK(arm.notes[2].find("link b: " + (folder / "b.obj").string() + ": 2.5 m large") == 0);
    CHECK(load(kArm + "</robot>").notes.empty());
}

TEST_CASE("The grasp moves a finger off the chain from its open to its closed position") {
    ArmOptions options;
    options.tip = "tip";
    options.fingers = {{"jaw", 0.0, 1.5707963267948966}};
    const ArmModel arm = load(kArm + "</robot>", options);
    REQUIRE(arm.fingers.size() == 1);
    REQUIRE(arm.leaves.size() == 4);
    CHECK(arm.leaves[3].joint == 1);
    CHECK(arm.leaves[3].finger == 1);
    ArmFrames open, closed;
    arm.place({0.0, 0.0}, Pose{}, open, 0.0);
    arm.place({0.0, 0.0}, Pose{}, closed, 1.0);
    CHECK(glm::distance(arm.centre(open, 3), arm.centre(closed, 3)) == doctest::Approx(0.1 * std::sqrt(2.0)));
    options.fingers = {{"jaw", {}, {}}};
    const ArmModel limits = load(kArm + "</robot>", options);
    CHECK(limits.fingers[0].open == -1.0);
    CHECK(limits.fingers[0].closed == 2.0);
    options.fingers = {{"turn", {}, {}}}; // of the chain
    CHECK(armRefusal(kArm + "</robot>", options).find("outside the chain") != std::string::npos);
    options.fingers = {{"jaw", {}, {}}, {"jaw", {}, {}}};
    CHECK(armRefusal(kArm + "</robot>", options).find("each finger once") != std::string::npos);
}
