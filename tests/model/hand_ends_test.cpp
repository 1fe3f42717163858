// SPDX-License-Identifier: Apache-2.0
// Where chains end at hands whose fingers are not alike, at joints that move several fingers, and at frames
// with the name of a tool before the last joints.
#include "tests/model/urdf_text.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <map>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Links 0 to n in a row; link k is named by `names` where it has one.
std::string armOf(int n, const std::map<int, std::string>& names = {}) {
    const auto link = [&](int k) { return names.count(k) > 0 ? names.at(k) : "l" + std::to_string(k); };
    std::string urdf = ballLink(link(0));
    for (int k = 1; k <= n; ++k) {
        urdf += ballLink(link(k));
        urdf += jointText("a" + std::to_string(k), "revolute", link(k - 1), link(k), "0 0 0.1",
                          k % 2 == 0 ? "0 1 0" : "1 0 0");
    }
    return urdf;
}

// A finger of so many joints on the link; mimic: joint that the first one follows.
std::string fingerOf(const std::string& name, int joints, const std::string& on,
                     const std::string& mimic = "") {
    std::string urdf, parent = on;
    for (int k = 1; k <= joints; ++k) {
        const std::string link = name + "_" + std::to_string(k);
        const std::string limit = "<limit lower='0' upper='1.5' velocity='1' effort='1'/>";
        urdf += ballLink(link, "0.005");
        urdf += jointText(name + "_joint" + std::to_string(k), "revolute", parent, link, "0 0.01 0.02",
                          "1 0 0", limit + (k == 1 && !mimic.empty() ? mimicText(mimic) : ""));
        parent = link;
    }
    return urdf;
}

// Joints in a row on the link, with links of their names, all behind a prefix.
std::string rowOf(const std::string& prefix, const std::vector<std::string>& joints, const std::string& on) {
    std::string urdf, parent = on;
    for (const std::string& joint : joints) {
        const std::string link = prefix + joint + "_link";
        urdf += ballLink(link);
        urdf += jointText(prefix + joint, "revolute", parent, link, "0 0 0.1", "1 0 0");
        parent = link;
    }
    return urdf;
}

// Fingers on l6, each behind a fixed link of its own.
std::string fixedFingers(const std::map<std::string, int>& fingers) {
    std::string urdf;
    for (const auto& [name, joints] : fingers) {
        urdf += ballLink(name + "_base") +
                jointText(name + "_mount", "fixed", "l6", name + "_base", "0 0 0.05", "0 0 1", "") +
                fingerOf(name, joints, name + "_base");
    }
    return urdf;
}

// A palm on the link, with three motors, a thumb of five joints and four fingers of so many.
std::string palmOn(const std::string& on, const std::string& palm, int joints) {
    std::string urdf = ballLink(palm) + jointText("palm_joint", "fixed", on, palm, "0 0 0.1", "0 0 1", "");
    for (const char* motor : {"m1", "m2", "m3"}) {
        urdf += fingerOf(motor, 1, palm);
    }
    urdf += fingerOf("flex", 5, palm);
    for (const char* finger : {"index", "middle", "ring", "little"}) {
        urdf += fingerOf(finger, joints, palm);
    }
    return urdf;
}

// Two fingers on `slider`, which slides on l3; each joint with its <mimic>, and `pads` joints of this kind on
// each finger.
std::string sliderWith(const std::string& slide, const std::string& mimicOfSlide,
                       const std::string& mimicOfLeft, const std::string& mimicOfRight, int pads,
                       const std::string& kind) {
    const std::string limit = "<limit lower='-0.02' upper='0.04' velocity='1' effort='1'/>";
    std::string urdf = ballLink("slider") + jointText(slide, "prismatic", "l3", "slider", "0 0 0.1", "1 0 0",
                                                      limit + mimicOfSlide);
    for (const auto& [name, mimic] : {std::pair{"left", mimicOfLeft}, {"right", mimicOfRight}}) {
        std::string parent = name;
        urdf += ballLink(name) +
                jointText(parent + "_open", "revolute", "slider", name, "0 0 0.1", "0 0 1", limit + mimic);
        for (int k = 1; k <= pads; ++k) {
            const std::string pad = name + std::to_string(k);
            urdf += ballLink(pad, "0.005");
            urdf += jointText(pad + "_pad", kind, parent, pad, "0 0 0.02", k % 2 == 0 ? "0 1 0" : "1 0 0");
            parent = pad;
        }
    }
    return urdf;
}

std::string endOf(const std::string& urdf) {
    const std::string text = loadUrdf(urdf).tipText;
    return text.substr(0, text.find(' '));
}

bool behindTip(const ArmModel& arm) {
    return std::any_of(arm.notes.begin(), arm.notes.end(), [](const std::string& note) {
        return note.find("behind the tip") != std::string::npos;
    });
}

} // namespace

TEST_CASE("A hand ends the chain though its thumb has other joints than its fingers") {
    const auto hand = [](int thumb, int finger, int little, const std::string& on) {
        return fingerOf("thumb", thumb, on) + fingerOf("index", finger, on) + fingerOf("middle", finger, on) +
               fingerOf("ring", finger, on) + fingerOf("pinky", little, on);
    };
    CHECK(endOf(armOf(6) + hand(4, 2, 2, "l6")) == "l6");
    CHECK(endOf(armOf(6) + hand(5, 4, 5, "l6")) == "l6"); // the thumb has five joints
    CHECK(endOf(armOf(6) + hand(2, 3, 3, "l6")) == "l6");
    const std::string yaw = fingerOf("thumb_proximal_yaw", 4, "l6") + fingerOf("index_finger", 2, "l6");
    CHECK(endOf(armOf(6) + yaw) == "l6");
}

TEST_CASE("A hand ends the chain though its motor or springs are joints of their own") {
    const std::string motor = fingerOf("motor", 1, "l5"), left = fingerOf("left", 3, "l5", "motor_joint1"),
                      right = fingerOf("right", 3, "l5", "motor_joint1");
    CHECK(endOf(armOf(5) + motor + left + right) == "l5");
    const std::string named =
        armOf(5, {{5, "wrist_roll_link"}}) + "<link name='hand_palm_link'/>" +
        jointText("palm", "fixed", "wrist_roll_link", "hand_palm_link", "0 0 0", "0 0 1");
    CHECK(endOf(named + fingerOf("motor", 1, "hand_palm_link") + fingerOf("left", 3, "hand_palm_link") +
                fingerOf("right", 3, "hand_palm_link")) == "hand_palm_link");
}

TEST_CASE("A hand ends the chain though its fingers hang on fixed links") {
    const std::string text =
        loadUrdf(armOf(6) + fixedFingers({{"index", 3}, {"middle", 3}, {"ring", 3}})).tipText;
    CHECK(text == "l6 (the end of the longest chain before a gripper)");
    CHECK(endOf(armOf(6) + fixedFingers({{"index", 4}, {"middle", 4}}) + fingerOf("ring", 3, "l6")) == "l6");
    CHECK(endOf(armOf(4) + ballLink("plate") +
                jointText("p", "fixed", "l4", "plate", "0 0 0.1", "0 0 1", "") +
                fingerOf("one", 2, "plate")) == "one_2"); // one branch is no hand
}

TEST_CASE("A hand by its name ends the chain though it has motors, a thumb and fingers of many joints") {
    CHECK(endOf(armOf(7) + palmOn("l7", "hand_palm_link", 7)) == "hand_palm_link");
    CHECK(loadUrdf(armOf(7) + palmOn("l7", "leftPalm", 7)).count() == 7);
    CHECK(loadUrdf(armOf(5) + palmOn("l5", "lhand_base", 5)).count() == 5);
    CHECK(urdfRefusal(armOf(7) + palmOn("l7", "mount", 7)).find("one more moving joint") !=
          std::string::npos);
    CHECK(loadUrdf(armOf(2) + palmOn("l2", "palm_link", 7)).count() == 9); // a hand without an arm
}

TEST_CASE("A chain with too many joints is rejected with the last tool frame on it, to set as its tip") {
    const std::string before = "arm.base and arm.tip shorten the chain";
    const std::string named = urdfRefusal(armOf(14, {{7, "arm_tool_link"}, {8, "my_palm"}, {13, "x"}}));
    CHECK(named.find(before + ", for example arm.tip: my_palm)") != std::string::npos);
    CHECK(urdfRefusal(armOf(14)).find(before + ")") != std::string::npos);
}

TEST_CASE("The note on a last joint that may close a gripper names the link where the fingers begin") {
    const auto note = [](const std::string& hand) {
        const ArmModel arm = loadUrdf(armOf(6) + hand);
        const auto found = std::ranges::find_if(arm.notes, [](const std::string& line) {
            return line.find("may close a gripper") != std::string::npos;
        });
        return found == arm.notes.end() ? "" : *found;
    };
    const std::string wanted = "joint long_joint4 (0 to 1.5 rad) is the last of the chain and may close a "
                               "gripper; if so, set arm.tip to l6";
    CHECK(note(fingerOf("long", 4, "l6") + fingerOf("mid", 2, "l6") + fingerOf("short", 1, "l6")) == wanted);
    CHECK(note(fixedFingers({{"long", 4}, {"mid", 2}, {"short", 1}})) == wanted);
    CHECK(note(fingerOf("long", 4, "l6")).ends_with("set arm.tip to long_3")); // no branch
}

TEST_CASE("A joint that joints on two branches below it mimic closes a gripper, whatever hangs on those") {
    const std::string tied = mimicText("m4", "multiplier='10'"), left = mimicText("left_open");
    for (const int pads : {0, 1, 2, 3}) {
        for (const char* kind : {"continuous", "revolute"}) {
            CAPTURE(pads);
            CHECK(endOf(armOf(3) + sliderWith("m4", "", tied, tied, pads, kind)) == "l3");
            CHECK(endOf(armOf(3) + sliderWith("m4", left, "", left, pads, kind)) == "l3");
        }
    }
    const ArmModel arm = loadUrdf(armOf(3) + sliderWith("m4", "", tied, tied, 2, "continuous"));
    CHECK(arm.tipText == "l3 (the end of the longest chain before a gripper)");
    CHECK(arm.count() == 3);
}

TEST_CASE("A joint named as a gripper's closes it though pads without limits hang on its fingers") {
    const std::string left = mimicText("left_open");
    CHECK(endOf(armOf(3) + sliderWith("gripper_slide", "", "", left, 2, "continuous")) == "l3");
}

TEST_CASE("A joint of an arm that moves balancers or rods, too, closes no gripper") {
    const auto tied = [](const std::string& name, const std::string& on, const std::string& more = "") {
        return ballLink(name) + jointText(name + "_joint", "revolute", on, name, "0 0.1 0", "0 1 0",
                                          "<limit lower='-2' upper='2' velocity='1' effort='1'/>" + more);
    };
    const std::string back = mimicText("a3", "multiplier='-1'");
    CHECK(endOf(armOf(6) + tied("b1", "l3", back) + tied("b2", "l3", back)) ==
          "l6"); // with the arm next to them
    const std::string level = tied("level", "l3", back), rest = rowOf("", {"w1", "w2", "w3"}, "level");
    CHECK(endOf(armOf(3) + level + rest + tied("rod", "l3", back)) == "w3_link"); // with the arm behind one
}

TEST_CASE("A trunk with two arms and a head is no hand") {
    const std::string two =
        armOf(2) + fingerOf("head", 1, "l2") + fingerOf("left", 4, "l2") + fingerOf("right", 4, "l2");
    CHECK(endOf(two) == "left_4");
    const std::string four =
        armOf(4) + fingerOf("head", 2, "l4") + fingerOf("left", 4, "l4") + fingerOf("right", 4, "l4");
    CHECK(endOf(four) == "left_4");
}

TEST_CASE("A link named as a tool before joints of the arm is no tip") {
    CHECK(endOf(armOf(6, {{5, "wrist_flange"}})) == "l6");
    CHECK(endOf(armOf(7, {{5, "forearm_hand"}})) == "l7");
    CHECK(endOf(armOf(6) + "<link name='calib_tool'/>" +
                jointText("c", "fixed", "l4", "calib_tool", "0 0 0", "0 0 1")) == "l6");
    const ArmModel exact = loadUrdf(armOf(6, {{5, "tool0"}})); // its maker says so
    CHECK(exact.tipText.find("tool0 ") == 0);
    CHECK(behindTip(exact));
}

TEST_CASE("A link named as a tool before joints that may be a gripper's is the tip") {
    const std::string slide = "<limit lower='0' upper='0.04' velocity='0.2' effort='1'/>";
    const ArmModel jaw = loadUrdf(armOf(6, {{6, "my_hand"}}) + ballLink("x") +
                                  jointText("x1", "prismatic", "my_hand", "x", "0 0 0.1", "0 0 1", slide));
    CHECK(jaw.tipText.find("my_hand ") == 0);
    CHECK_FALSE(behindTip(jaw));
    CHECK(endOf(armOf(6, {{6, "my_hand"}}) + fingerOf("left", 2, "my_hand")) == "my_hand");
}

TEST_CASE("A word in the prefix of a robot's names makes none of its joints a gripper's or a wrist's") {
    const std::vector<std::string> arm{"pan", "lift", "elbow", "wrist_1", "wrist_2", "wrist_3"};
    const std::string world = ballLink("world"), tilt = rowOf("tilt_", {"pan", "lift"}, "world");
    for (const char* prefix : {"gripper_arm_", "left_claw_", "Clamp-", "pincher/", "finger2_", "wrist_"}) {
        const std::string end = std::string(prefix) + "wrist_3_link";
        CHECK_MESSAGE(endOf(world + rowOf(prefix, arm, "world") + tilt) == end, prefix);
    }
    const std::vector<std::string> jaw{"pan", "lift", "elbow", "flex", "gripper_joint"};
    for (const char* prefix : {"phantomx_pincher_", "trolley_", "roller_", "rotating-", "controller_"}) {
        const std::string end = std::string(prefix) + "flex_link";
        CHECK_MESSAGE(endOf(world + rowOf(prefix, jaw, "world")) == end, prefix);
    }
    CHECK(endOf(world + rowOf("gripper_arm_", arm, "world") +
                fingerOf("gripper", 1, "gripper_arm_wrist_3_link")) == "gripper_arm_wrist_3_link");
}

TEST_CASE("Words of grippers and wrists count at the start or end of a part of a name") {
    for (const char* joint : {"leftGripper", "RFinger1", "rfinger", "left-jaw", "fingertip", "innerknuckle2",
                              "eegripper", "GRIP", "tongs", "clamping"}) {
        CHECK_MESSAGE(endOf(armOf(3) + rowOf("", {joint}, "l3")) == "l3", joint);
    }
    CHECK(endOf(armOf(3) + rowOf("", {"agriplow"}, "l3")) == "agriplow_link");
    CHECK(endOf(armOf(3) + rowOf("", {"gripper_wristroll"}, "l3")) == "gripper_wristroll_link");
    CHECK(endOf(armOf(3) + rowOf("", {"trolley_gripper"}, "l3")) == "l3");
}

TEST_CASE("A joint with more than two moving joints behind it is no gripper's, unless a finger's") {
    CHECK(endOf(armOf(3) + rowOf("", {"clamp_mount", "u", "v", "w"}, "l3")) == "w_link");
    CHECK(endOf(armOf(3) + rowOf("", {"clamp_mount", "u", "v"}, "l3")) == "l3");
    CHECK(endOf(armOf(3) + rowOf("", {"thumb_yaw", "u", "v", "w"}, "l3")) == "l3");
}

TEST_CASE("A chain that is as long as the arm's and ends early by a gripper's name gives a note") {
    const std::string note = "a chain of 4 joints to v_link is left out: joint clamp_mount seems to be a "
                             "gripper's by its names; arm.tip selects another";
    const std::string other = rowOf("", {"m", "clamp_mount", "u", "v"}, "l0");
    CHECK(loadUrdf(armOf(4) + other).notes == std::vector<std::string>{note});
    CHECK(loadUrdf(armOf(5) + other).notes.empty());
    CHECK(loadUrdf(armOf(4) + rowOf("", {"clamp_mount", "u", "v"}, "l4")).notes.empty());
}
