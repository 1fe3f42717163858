// SPDX-License-Identifier: Apache-2.0
// Which base and tip the tree of a URDF gives, and what happens with the rest of the robot.
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// a - j1 - b - j2 - c, with more links and joints.
std::string twoJoints(const std::string& more) {
    return ballLink("a") + ballLink("b") + ballLink("c") +
           jointText("j1", "revolute", "a", "b", "0 0 0.2", "0 1 0") +
           jointText("j2", "revolute", "b", "c", "0 0 0.4", "1 0 0") + more;
}

std::string tipOf(const std::string& urdf) {
    return loadUrdf(urdf).tipText;
}

std::string sevenJoints() {
    std::string urdf = ballLink("0");
    for (int k = 1; k <= 7; ++k) {
        const std::string before = std::to_string(k - 1), after = std::to_string(k);
        urdf += ballLink(after);
        urdf += jointText(std::string("j").append(after), "revolute", before, after, "0 0 0.1",
                          k % 2 == 0 ? "0 1 0" : "1 0 0");
    }
    return urdf;
}

} // namespace

TEST_CASE("The tip is the frame with a usual name, and a gripper's joint is not part of the chain") {
    const std::string jaw =
        ballLink("claw_link") + jointText("turn", "revolute", "c", "claw_link", "0 0 0.1", "1 0 0");
    const ArmModel arm = loadUrdf(twoJoints(jaw + "<link name='left_tool0'/>" +
                                            jointText("f", "fixed", "c", "left_tool0", "0 0 0.15", "0 0 1")));
    CHECK(arm.count() == 2);
    CHECK(arm.tipText == "left_tool0 (a tool frame by its name)");
    CHECK(arm.held == std::vector<std::string>{"turn stays at 0 (not between base and tip)"});
    CHECK(tipOf(twoJoints(jaw)) == "c (the end of the longest chain before a gripper)");
}

TEST_CASE("A chain ends at the hand before fingers, whatever their names") {
    const std::string slide = "<limit lower='0' upper='0.04' velocity='0.2' effort='1'/>";
    const std::string hand = "<link name='hand'/>" + jointText("h", "fixed", "7", "hand", "0 0 0.1", "0 0 1");
    const ArmModel seven = loadUrdf(sevenJoints() + hand + ballLink("x") +
                                    jointText("x1", "prismatic", "hand", "x", "0 0 0", "0 1 0", slide));
    CHECK(seven.count() == 7);
    CHECK(seven.tipText == "hand (a tool frame by its name)");
    const std::string fingers = ballLink("l") + ballLink("r") +
                                jointText("f1", "prismatic", "c", "l", "0 0 0", "0 1 0", slide) +
                                jointText("f2", "prismatic", "c", "r", "0 0 0", "0 -1 0", slide);
    CHECK(tipOf(twoJoints(fingers)) == "c (the end of the longest chain before a gripper)");
}

TEST_CASE("A single jaw ends the chain by its names, or by its motion across the hand") {
    const auto jawTip = [](const std::string& joint, const std::string& kind, const std::string& at,
                           const std::string& axis, const std::string& limit) {
        return tipOf(twoJoints(ballLink("e") + jointText(joint, kind, "c", "e", at, axis, limit)));
    };
    const std::string turn = "<limit lower='0' upper='1' velocity='1' effort='1'/>",
                      slide = "<limit lower='0' upper='0.04' velocity='0.2' effort='1'/>",
                      before = "c (the end of the longest chain before a gripper)",
                      end = "e (the end of the longest chain)";
    for (const char* joint : {"grip", "grasp_joint", "clamp", "pinch", "tongs", "forceps", "opening"}) {
        CHECK_MESSAGE(jawTip(joint, "revolute", "0 0 0.1", "0 1 0", turn) == before, joint);
    }
    CHECK(jawTip("grip_rotation", "revolute", "0 0 0.1", "0 1 0", turn) == end);
    CHECK(jawTip("drive_x", "prismatic", "0 0 0.1", "0 1 0", slide) == before); // j2 turns about x
    CHECK(jawTip("drive_x", "prismatic", "0 0 0", "0 1 0", slide) == before);
    CHECK(jawTip("needle", "prismatic", "0 0 0.1", "0 0 1", slide) == end);
    CHECK(jawTip("quill", "prismatic", "0 0 0", "1 0 0", slide) == end);
    CHECK(jawTip("long", "prismatic", "0 0 0.1", "0 1 0",
                 "<limit lower='0' upper='0.3' velocity='0.2' effort='1'/>") == end);
    CHECK(jawTip("both", "prismatic", "0 0 0.1", "0 1 0",
                 "<limit lower='-0.04' upper='0.04' velocity='0.2' effort='1'/>") == end);
}

TEST_CASE("A last joint that moves little and to one side gives a note that it may close a gripper") {
    const auto notes = [](const std::string& joint, const std::string& limit) {
        return loadUrdf(
                   twoJoints(ballLink("e") + jointText(joint, "revolute", "c", "e", "0 0 0.1", "0 1 0",
                                                       "<limit " + limit + " velocity='1' effort='1'/>")))
            .notes;
    };
    CHECK(notes("m6", "lower='0' upper='1.2'") ==
          std::vector<std::string>{
              "joint m6 (0 to 1.2 rad) is the last of the chain and may close a gripper; if so, "
              "set arm.tip to c"});
    CHECK(notes("m6", "lower='-1.2' upper='1.2'").empty());
    CHECK(notes("m6", "lower='0' upper='3'").empty());
    CHECK(notes("wrist_3", "lower='0' upper='1.2'").empty());
}

TEST_CASE("Without a usual name the tip is the end of the longest chain, or the frame fixed to it") {
    CHECK(tipOf(twoJoints("")) == "c (the end of the longest chain)");
    CHECK(tipOf(twoJoints("<link name='t'/>" + jointText("f", "fixed", "c", "t", "0 0 0.4", "0 0 1"))) ==
          "t (the frame fixed to the end of the longest chain)");
    CHECK(tipOf(twoJoints(ballLink("camera") + jointText("f", "fixed", "c", "camera", "0 0 0.4", "0 0 1"))) ==
          "c (the end of the longest chain)");
    CHECK(tipOf(twoJoints(
              "<link name='s'/><link name='t'/>" + jointText("f", "fixed", "c", "t", "0 0 0.4", "0 0 1") +
              jointText("g", "fixed", "c", "s", "0 0 0.4", "0 0 1"))) == "c (the end of the longest chain)");
}

TEST_CASE("A joint that turns a gripper belongs to the chain, and a tool frame far from its end is no tip") {
    CHECK(loadUrdf(twoJoints(ballLink("gripper") +
                             jointText("gripper_roll", "revolute", "c", "gripper", "0 0 0.1", "0 0 1")))
              .count() == 3);
    CHECK(loadUrdf(sevenJoints() + "<link name='tool'/>" +
                   jointText("f", "fixed", "4", "tool", "0 0 0.1", "0 0 1"))
              .count() == 7);
}

TEST_CASE("Chains of the same length give a note that names the other ends") {
    const ArmModel arm = loadUrdf(twoJoints(ballLink("d") + ballLink("e") +
                                            jointText("k1", "revolute", "a", "d", "0 0.2 0", "0 1 0") +
                                            jointText("k2", "revolute", "d", "e", "0 0 0.4", "1 0 0")));
    REQUIRE(arm.notes.size() == 1);
    CHECK(arm.notes[0] == "tip c is one of several ends of chains with 2 joints; arm.tip selects another: e");
}

TEST_CASE("The other ends are the frames that would be the tips of their branches") {
    const auto other = [](const std::string& end) {
        const std::string branch = ballLink("d") + ballLink("e") +
                                   jointText("k1", "revolute", "a", "d", "0 0.2 0", "0 1 0") +
                                   jointText("k2", "revolute", "d", "e", "0 0 0.4", "1 0 0");
        const ArmModel arm = loadUrdf(twoJoints(branch + end));
        REQUIRE(arm.notes.size() == 1);
        return arm.notes[0].substr(arm.notes[0].rfind(": ") + 2);
    };
    const std::string hand = ballLink("right_hand") +
                             jointText("h", "fixed", "e", "right_hand", "0 0 0.1", "0 0 1"),
                      tcp = "<link name='right_hand_tcp'/>" +
                            jointText("t", "fixed", "right_hand", "right_hand_tcp", "0 0 0.1", "0 0 1"),
                      slide = "<limit lower='0' upper='0.04' velocity='0.2' effort='1'/>";
    CHECK(other(hand + "<link name='tool0'/>" + jointText("f", "fixed", "c", "tool0", "0 0 0.1", "0 0 1")) ==
          "right_hand");
    CHECK(other(hand + tcp + "<link name='hand_tcp'/>" +
                jointText("f", "fixed", "c", "hand_tcp", "0 0 0.1", "0 0 1") + ballLink("right_finger") +
                jointText("g", "prismatic", "right_hand", "right_finger", "0 0 0", "0 1 0", slide)) ==
          "right_hand_tcp");
    CHECK(other("<link name='mark'/>" + jointText("f", "fixed", "e", "mark", "0 0 0.1", "0 0 1")) == "mark");
}

TEST_CASE("Links that carry the base, and those of other branches, stay where they are and have leaves") {
    ArmOptions options;
    options.base = "b";
    const ArmModel arm = loadUrdf(
        twoJoints(ballLink("mast") + jointText("m", "fixed", "a", "mast", "0 0.3 0", "0 0 1")), options);
    CHECK(arm.count() == 1);
    CHECK(arm.baseText == "b (named by the scene)");
    CHECK(arm.notes == std::vector<std::string>{"base_T_arm is the pose of b, not of the root a above it"});
    REQUIRE(arm.links == std::vector<std::string>{"b", "c", "a", "mast"});
    ArmFrames frames;
    arm.place({}, Pose{}, frames);
    CHECK(glm::distance(arm.centre(frames, 2), dvec3(0.0, 0.0, -0.2)) < 1e-12);
    CHECK(glm::distance(arm.centre(frames, 3), dvec3(0.0, 0.3, -0.2)) < 1e-12);
    CHECK(arm.leaves[3].joint == 0);
}

TEST_CASE("A base that is named has no note where it is the root, or at the same pose") {
    const auto notes = [](const std::string& base, const std::string& at) {
        ArmOptions options;
        options.base = base;
        const std::string root = "<link name='world'/>" + jointText("w", "fixed", "world", "a", at, "0 0 1");
        return loadUrdf(twoJoints(root), options).notes;
    };
    CHECK(notes("world", "0 0 1").empty());
    CHECK(notes("a", "0 0 0").empty());
    CHECK(notes("a", "0 0 1") ==
          std::vector<std::string>{"base_T_arm is the pose of a, not of the root world above it"});
}

TEST_CASE(
    "The base is the link below a planar or floating joint, and what is above is named if it has shapes") {
    const std::string vehicle = jointText("drive", "floating", "world", "a", "0 0 0", "0 0 1", "");
    const ArmModel bare = loadUrdf(twoJoints("<link name='world'/>" + vehicle));
    CHECK(bare.baseText == "a (below the planar or floating joint drive)");
    CHECK(bare.notes.empty());
    const ArmModel walls = loadUrdf(twoJoints(ballLink("world") + vehicle));
    REQUIRE(walls.notes.size() == 1);
    CHECK(walls.notes[0].find("link world and what hangs on it beside joint drive") == 0);
}

TEST_CASE("A planar or floating joint at the end of a chain does not belong to it") {
    for (const char* type : {"floating", "planar"}) {
        const std::string end = ballLink("d") + jointText("loose", type, "c", "d", "0 0 0.4", "0 0 1");
        const ArmModel arm = loadUrdf(twoJoints(end));
        CHECK(arm.count() == 2);
        CHECK(arm.tipText == "c (the end of the longest chain)");
        CHECK(arm.links.size() == 4);
        CHECK(arm.notes ==
              std::vector<std::string>{
                  "link d is only guarded where joint loose, which is planar, floating or a ball, is 0"});
        CHECK(tipOf(twoJoints(end + "<link name='tool0'/>" +
                              jointText("f", "fixed", "d", "tool0", "0 0 0", "0 0 1"))) ==
              "c (the end of the longest chain)");
        ArmOptions options;
        options.tip = "d";
        CHECK(urdfRefusal(twoJoints(end), options).find("or arm.tip ends above it") != std::string::npos);
    }
}

TEST_CASE(
    "A joint without speed gets a default that is named, and a shape of size 0 is skipped with a note") {
    const ArmModel arm =
        loadUrdf("<link name='root'><collision><geometry><box size='0 0 0'/></geometry></collision></link>" +
                 twoJoints(jointText("m", "fixed", "root", "a", "0 0 0", "0 0 1", "") + ballLink("d") +
                           jointText("j3", "continuous", "c", "d", "0 0 0.1", "0 0 1", "")));
    CHECK(arm.links == std::vector<std::string>{"a", "b", "c", "d"});
    REQUIRE(arm.notes.size() == 1);
    CHECK(arm.notes[0] == "link root: a shape of size 0 is skipped");
    CHECK(arm.joints[2].speed == kUnknownTurn);
    CHECK(arm.joints[2].speedFrom == kDefaultSpeedSource);
    CHECK(
        urdfRefusal("<link name='a'><collision><geometry><box size='1 -1 1'/></geometry></collision></link>")
            .find("link a: a shape with a negative size") != std::string::npos);
}

TEST_CASE("A missing mesh names the places that were searched and the key that adds one") {
    const std::string refusal = urdfRefusal(
        "<link name='a'><collision><geometry><mesh filename='package://some_arm/meshes/base.stl'/></geometry>"
        "</collision></link>");
    CHECK(refusal.find("link a: mesh 'package://some_arm/meshes/base.stl' not found; looked for ") !=
          std::string::npos);
    CHECK(refusal.find("/some_arm/meshes/base.stl, ") != std::string::npos);
    CHECK(refusal.find("arm.meshes names the folder") != std::string::npos);
}

TEST_CASE("The scheme of a mesh name may have capitals, and a drive of Windows is no address") {
    for (const auto& [name, place] :
         {std::pair<std::string, std::string>{"PACKAGE://some_arm/m.stl", "/some_arm/m.stl, "},
          {"Model://some_arm/m.stl", "/some_arm/m.stl, "},
          {"FILE:///no/m.stl", " /no/m.stl "},
          {"C://m.stl", "/m.stl"}}) {
        const std::string refusal = urdfRefusal("<link name='a'><collision><geometry><mesh filename='" +
                                                name + "'/></geometry></collision></link>");
        CHECK(refusal.find("not found; looked for ") != std::string::npos);
        CHECK(refusal.find(place) != std::string::npos);
    }
}

TEST_CASE("A missing mesh whose name begins with file: without slashes is told how to write it") {
    CHECK(urdfRefusal("<link name='a'><collision><geometry><mesh filename='file:s1.stl'/></geometry>"
                      "</collision></link>")
              .find("mesh 'file:s1.stl' not found (allowed: file:// before an absolute path, or a path "
                    "without file:)") != std::string::npos);
}

TEST_CASE("A mesh on the web is named as such, with the names that are read") {
    for (const std::string scheme : {"https://", "omniverse://"}) {
        const std::string name = scheme + "example.org/m.stl";
        const std::string refusal = urdfRefusal("<link name='a'><collision><geometry><mesh filename='" +
                                                name + "'/></geometry></collision></link>");
        CAPTURE(refusal);
        CHECK(refusal.find("link a: mesh '" + name + "' is an address of " + scheme +
                           " (allowed: a file on this machine: download it") != std::string::npos);
    }
}

TEST_CASE("Among frames of one name the bare one behind the others is the tip, and a finger may be short") {
    const std::string hand = ballLink("gripper_link") +
                             "<link name='ee_gripper_link'><inertial><mass value='0.001'/><inertia ixx='1' "
                             "ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>" +
                             jointText("f", "fixed", "c", "gripper_link", "0 0 0.1", "0 0 1") +
                             jointText("g", "fixed", "gripper_link", "ee_gripper_link", "0 0 0.1", "0 0 1");
    CHECK(tipOf(twoJoints(hand)) == "ee_gripper_link (a tool frame by its name)");
    CHECK(tipOf(twoJoints(ballLink("arm_link_fngr") +
                          jointText("f1x", "revolute", "c", "arm_link_fngr", "0 0 0.1", "0 1 0"))) ==
          "c (the end of the longest chain before a gripper)");
}
