// SPDX-License-Identifier: Apache-2.0
// Mimic joints of a URDF: on the chain, in grippers, and off the chain.
#include "tests/model/urdf_text.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kWide = "<limit lower='-3' upper='3' velocity='1' effort='1'/>";
const std::string kFinger = "<limit lower='0' upper='0.04' velocity='0.2' effort='1'/>";

// Three links along z that turn about x; the second joint is given by the test.
std::string chainWith(const std::string& second) {
    return ballLink("a") + ballLink("b") + ballLink("c") + ballLink("d") +
           jointText("j1", "revolute", "a", "b", "0 0 0", "1 0 0") +
           jointText("j2", "revolute", "b", "c", "0 0 0.6", "1 0 0", second) +
           jointText("j3", "revolute", "c", "d", "0 0 0.4", "1 0 0");
}

const std::string kHand = ballLink("a") + ballLink("b") + ballLink("hand") + ballLink("fl", "0.01") +
                          ballLink("fr", "0.01") + jointText("j1", "revolute", "a", "b", "0 0 0.2", "0 1 0") +
                          jointText("j2", "revolute", "b", "hand", "0 0 0.4", "1 0 0");

dvec3 centreOf(const ArmModel& arm, const std::string& link, const JointVector& q, double grasp = 0.0) {
    ArmFrames frames;
    arm.place(q, Pose{}, frames, grasp);
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        if (arm.links[arm.leaves[i].link] == link) {
            return arm.centre(frames, i);
        }
    }
    return dvec3(NAN);
}

} // namespace

TEST_CASE("A mimic joint of the chain follows its joint with multiplier and offset, and narrows its range") {
    const ArmModel arm = loadUrdf(chainWith(kWide + mimicText("j1", "multiplier='-1.5' offset='0.5'")));
    REQUIRE(arm.count() == 3);
    REQUIRE(arm.joints[1].mimic);
    JointVector q{0.4, 9.0, 0.1};
    arm.follow(q);
    CHECK(q[1] == doctest::Approx(0.5 - 1.5 * 0.4));
    CHECK(arm.joints[0].lower == doctest::Approx(-2.5 / 1.5)); // j2 at 3
    CHECK(arm.joints[0].upper == doctest::Approx(2.0));
    CHECK(arm.joints[0].speed == doctest::Approx(1.0 / 1.5));
    CHECK(arm.joints[0].limitsFrom == "mimic joint j2");

    JointVector zero{};
    arm.follow(zero);
    CHECK(glm::distance(centreOf(arm, "d", zero),
                        dvec3(0.0, -0.4 * std::sin(0.5), 0.6 + 0.4 * std::cos(0.5))) < 1e-12);
}

TEST_CASE("A mimic joint of a mimic joint follows the joint that follows none") {
    const std::string third = "<limit lower='-9' upper='9' velocity='9' effort='1'/>" +
                              mimicText("j2", "multiplier='2' offset='0.1'");
    const ArmModel arm = loadUrdf(ballLink("a") + ballLink("b") + ballLink("c") + ballLink("d") +
                                  jointText("j1", "revolute", "a", "b", "0 0 0", "1 0 0") +
                                  jointText("j2", "revolute", "b", "c", "0 0 0.6", "1 0 0",
                                            kWide + mimicText("j1", "multiplier='-1' offset='0.5'")) +
                                  jointText("j3", "revolute", "c", "d", "0 0 0.4", "1 0 0", third));
    JointVector q{0.3};
    arm.follow(q);
    CHECK(q[1] == doctest::Approx(0.2));
    CHECK(q[2] == doctest::Approx(2.0 * 0.2 + 0.1));
}

TEST_CASE("Two joints of the chain that mimic a joint off the chain stay tied to each other") {
    const std::string off =
        ballLink("crank") + jointText("motor", "revolute", "a", "crank", "0 0.1 0", "1 0 0");
    const ArmModel arm = loadUrdf(ballLink("a") + ballLink("b") + ballLink("c") + ballLink("d") + off +
                                  jointText("j1", "revolute", "a", "b", "0 0 0", "1 0 0",
                                            kWide + mimicText("motor", "multiplier='2'")) +
                                  jointText("j2", "revolute", "b", "c", "0 0 0.6", "1 0 0",
                                            kWide + mimicText("motor", "multiplier='-1' offset='0.5'")) +
                                  jointText("j3", "revolute", "c", "d", "0 0 0.4", "1 0 0"));
    JointVector q{0.8}; // the motor at 0.4
    arm.follow(q);
    CHECK_FALSE(arm.joints[0].mimic);
    CHECK(q[1] == doctest::Approx(0.1));
    REQUIRE(arm.fingers.size() == 1); // the crank moves with the chain
    ArmFrames frames;
    arm.place(q, Pose{}, frames);
    CHECK(2.0 * std::asin(frames[kMaxJoints + 1].rotation.x) == doctest::Approx(0.4));
}

TEST_CASE("A finger that mimics another one moves with the grasp") {
    ArmOptions options;
    options.tip = "hand";
    options.fingers = {{"f1", 0.04, 0.0}};
    const ArmModel arm =
        loadUrdf(kHand + jointText("f1", "prismatic", "hand", "fl", "0 0 0", "0 1 0", kFinger) +
                     jointText("f2", "prismatic", "hand", "fr", "0 0 0", "0 -1 0", kFinger + mimicText("f1")),
                 options);
    REQUIRE(arm.fingers.size() == 2);
    CHECK(centreOf(arm, "fl", {}, 0.0).y - centreOf(arm, "fr", {}, 0.0).y == doctest::Approx(0.08));
    CHECK(centreOf(arm, "fl", {}, 1.0).y - centreOf(arm, "fr", {}, 1.0).y == doctest::Approx(0.0));
    options.fingers = {{"f1", 0.04, 0.0}, {"f2", 0.03, {}}};
    CHECK(urdfRefusal(
              kHand + jointText("f1", "prismatic", "hand", "fl", "0 0 0", "0 1 0", kFinger) +
                  jointText("f2", "prismatic", "hand", "fr", "0 0 0", "0 -1 0", kFinger + mimicText("f1")),
              options)
              .find("finger f2: 0.03 (allowed: 0.04, as it moves with joint f1)") != std::string::npos);
}

TEST_CASE(
    "A finger that hangs on a finger and mimics it backwards keeps its direction, as in parallel jaws") {
    ArmOptions options;
    options.tip = "hand";
    options.fingers = {{"f1", 0.0, 0.8}};
    const std::string turn = "<limit lower='-0.9' upper='0.9' velocity='1' effort='1'/>";
    const ArmModel arm =
        loadUrdf(kHand + jointText("f1", "revolute", "hand", "fl", "0 0.05 0", "1 0 0", turn) +
                     jointText("f2", "revolute", "fl", "fr", "0 0 0.1", "1 0 0",
                               turn + mimicText("f1", "multiplier='-1'")),
                 options);
    REQUIRE(arm.fingers.size() == 2);
    CHECK(arm.fingers[1].carrier == 1);
    ArmFrames frames;
    arm.place({}, Pose{}, frames, 1.0);
    CHECK(glm::distance(frames[kMaxJoints + 2].position - frames[0].position,
                        dvec3(0.0, 0.05 - 0.1 * std::sin(0.8), 0.6 + 0.1 * std::cos(0.8))) < 1e-12);
    CHECK(frames[kMaxJoints + 2].rotation.w == doctest::Approx(1.0)); // turned back
}

TEST_CASE("A locked joint stays at its value and its mimic joints with it") {
    ArmOptions options;
    options.locked = {{"j1", 0.4}};
    const ArmModel arm =
        loadUrdf(chainWith(kWide + mimicText("j1", "multiplier='-1.5' offset='0.5'")), options);
    REQUIRE(arm.count() == 1);
    const double first = 0.4, second = 0.5 - 1.5 * 0.4 + 0.4;
    CHECK(glm::distance(centreOf(arm, "d", {}), dvec3(0.0, -0.6 * std::sin(first) - 0.4 * std::sin(second),
                                                      0.6 * std::cos(first) + 0.4 * std::cos(second))) <
          1e-12);
    CHECK(arm.held ==
          std::vector<std::string>{"j1 stays at 0.4 (locked by the scene)", "j2 stays at -0.1 (follows j1)"});
    options.locked = {{"j1", 2.5}};
    CHECK(urdfRefusal(chainWith(kWide), options).find("locked j1: 2.5 (allowed: -2 to 2") !=
          std::string::npos);
    options.locked = {{"elbow", 0.0}};
    CHECK(urdfRefusal(chainWith(kWide), options).find("locked: 'elbow'") != std::string::npos);
    options.locked = {{"j1", 0.4}, {"j2", 0.4}};
    CHECK(urdfRefusal(chainWith(kWide + mimicText("j1")), options) == "");
    options.locked = {{"j1", 0.4}, {"j2", 0.5}};
    CHECK(urdfRefusal(chainWith(kWide + mimicText("j1")), options).find("agrees with joint j1") !=
          std::string::npos);
}

TEST_CASE("Mimic joints that follow themselves, each other or nothing are rejected in one line") {
    CHECK(urdfRefusal(chainWith(kWide + mimicText("j2")))
              .find("joint j2, mimic: 'j2' (allowed: a joint that ") != std::string::npos);
    CHECK(urdfRefusal(chainWith(kWide + mimicText("nowhere")))
              .find("joint j2, mimic: 'nowhere' (allowed: a joint of the robot)") != std::string::npos);
    const std::string circle =
        ballLink("a") + ballLink("b") + ballLink("c") +
        jointText("j1", "revolute", "a", "b", "0 0 0", "1 0 0", kWide + mimicText("j2")) +
        jointText("j2", "revolute", "b", "c", "0 0 0.6", "1 0 0", kWide + mimicText("j1"));
    CHECK(urdfRefusal(circle).find("joint j1, mimic: ") != std::string::npos);
}

TEST_CASE("Limits of a mimic joint that leave no value for the followed joint are ignored with a note") {
    const ArmModel arm =
        loadUrdf(chainWith("<limit lower='2.5' upper='3' velocity='1' effort='1'/>" + mimicText("j1")));
    CHECK(arm.joints[0].lower == -2.0);
    REQUIRE(arm.notes.size() == 1);
    CHECK(arm.notes[0] ==
          "joint j2: its limits leave no value for joint j1, which it follows, and are ignored");
}

TEST_CASE("A joint of the chain that follows one behind it stays in the chain, and fingers do not") {
    const auto chain = [](const std::string& first, const std::string& second, const std::string& more = "") {
        return ballLink("a") + ballLink("b") + ballLink("c") + ballLink("d") + more +
               jointText("j1", "revolute", "a", "b", "0 0 0.3", "0 1 0", kWide + first) +
               jointText("j2", "revolute", "b", "c", "0 0 0.3", "0 1 0", kWide + second) +
               jointText("j3", "revolute", "c", "d", "0 0 0.3", "0 1 0", kWide);
    };
    for (const auto& [first, second] :
         {std::pair{mimicText("j3", "multiplier='-0.5' offset='0.1'"), std::string()},
          {std::string(), mimicText("j3", "multiplier='2'")},
          {mimicText("j2"), mimicText("j3", "multiplier='2'")}}) {
        const ArmModel arm = loadUrdf(chain(first, second));
        CHECK(arm.tipText == "d (the end of the longest chain)");
        CHECK(arm.count() == 3);
    }
    CHECK(loadUrdf(chain(mimicText("j3"), "",
                         "<link name='tool0'/>" + jointText("f", "fixed", "d", "tool0", "0 0 0.1", "0 0 1")))
              .tipText == "tool0 (a tool frame by its name)");
    const std::string fingers =
        ballLink("e") + ballLink("f") + jointText("f1", "revolute", "d", "e", "0 0 0", "1 0 0", kWide) +
        jointText("f2", "revolute", "d", "f", "0 0 0", "1 0 0", kWide + mimicText("f1"));
    CHECK(loadUrdf(chain("", "", fingers)).tipText == "d (the end of the longest chain before a gripper)");
    const std::string tipped =
        fingers + ballLink("g") +
        jointText("f3", "revolute", "f", "g", "0 0 0", "1 0 0", kWide + mimicText("f1"));
    CHECK(loadUrdf(chain("", "", tipped)).tipText == "d (the end of the longest chain before a gripper)");
}

TEST_CASE("A joint that mimics a fixed joint is held, with a note, and does not end the chain") {
    const ArmModel arm = loadUrdf(
        ballLink("a") + ballLink("b") + ballLink("c") + ballLink("d") + "<link name='x'/>" +
        jointText("fx", "fixed", "a", "x", "0 0 0", "1 0 0") +
        jointText("j1", "revolute", "a", "b", "0 0 0.3", "0 1 0", kWide) +
        jointText("j2", "revolute", "b", "c", "0 0 0.3", "0 1 0", kWide) +
        jointText("j3", "revolute", "c", "d", "0 0 0.3", "0 1 0", kWide + mimicText("fx", "offset='0.2'")));
    CHECK(arm.tipText == "d (the end of the longest chain)");
    CHECK(arm.held == std::vector<std::string>{"j3 stays at 0.2 (follows fx, which is fixed)"});
}

TEST_CASE("A joint that its mimic holds beyond its own limits is reported") {
    const ArmModel arm = loadUrdf(chainWith(kWide + mimicText("j1", "multiplier='0' offset='5'")));
    REQUIRE(arm.notes.size() == 1);
    CHECK(arm.notes[0] == "joint j2: stays at 5, beyond its limits -3 to 3");
}

TEST_CASE("A finger that its mimic takes beyond its own limits is reported, and not for the last digits") {
    const auto notesWith = [](const std::string& limits) {
        ArmOptions options;
        options.tip = "hand";
        options.fingers = {{"f1", 0.04, 0.0}};
        return loadUrdf(kHand + jointText("f1", "prismatic", "hand", "fl", "0 0 0", "0 1 0", kFinger) +
                            jointText("f2", "prismatic", "hand", "fr", "0 0 0", "0 1 0",
                                      "<limit " + limits + " velocity='1' effort='1'/>" +
                                          mimicText("f1", "multiplier='-1'")),
                        options)
            .notes;
    };
    CHECK(notesWith("lower='-0.0399' upper='0'").empty());
    CHECK(notesWith("lower='0' upper='0.04'") ==
          std::vector<std::string>{
              "finger f2: its mimic takes it from -0.04 to 0, beyond its limits 0 to 0.04"});
}

TEST_CASE("Sliding fingers without stated positions close towards 0, and a note says which they are") {
    const auto fingerOf = [](const std::string& type, const std::string& limits) {
        ArmOptions options;
        options.tip = "hand";
        options.fingers = {{"f1", {}, {}}};
        return loadUrdf(kHand + ballLink("x") +
                            jointText("f1", type, "hand", "fl", "0 0 0", "0 1 0",
                                      "<limit " + limits + " velocity='1' effort='1'/>") +
                            jointText("f2", "fixed", "hand", "fr", "0 0 0", "0 1 0", "") +
                            jointText("f3", "fixed", "hand", "x", "0 0 0", "0 1 0", ""),
                        options);
    };
    for (const auto& [limits, open, closed] : {std::tuple{"lower='0' upper='0.04'", 0.04, 0.0},
                                               {"lower='0.021' upper='0.057'", 0.057, 0.021},
                                               {"lower='-0.05' upper='0.01'", -0.05, 0.01}}) {
        const ArmModel arm = fingerOf("prismatic", limits);
        CHECK(arm.fingers.at(0).open == open);
        CHECK(arm.fingers.at(0).closed == closed);
    }
    const ArmModel arm = fingerOf("prismatic", "lower='0' upper='0.04'");
    CHECK(
        std::find(
            arm.notes.begin(), arm.notes.end(),
            "finger f1: open at 0.04 and closed at 0, as the shapes of the fingers show; grasp.fingers sets "
            "both") != arm.notes.end());
    const ArmModel turning = fingerOf("revolute", "lower='0' upper='0.8'");
    CHECK(turning.fingers.at(0).open == 0.0);
    CHECK(turning.fingers.at(0).closed == 0.8);
}

TEST_CASE("A joint that mimics one above the base, or that one mimics, stays with it where it is") {
    const auto armWith = [&](const std::string& first, const std::string& second) {
        ArmOptions options;
        options.base = "a";
        return loadUrdf(ballLink("0") + jointText("m", "revolute", "0", "a", "0 0 0.1", "1 0 0", first) +
                            chainWith(second),
                        options);
    };
    const ArmModel follower = armWith(kWide, kWide + mimicText("m", "multiplier='-1'"));
    CHECK(follower.count() == 2);
    CHECK(follower.held ==
          std::vector<std::string>{"j2 stays at 0 (follows m)", "m stays at 0 (above the base)"});
    const ArmModel leader = armWith(kWide + mimicText("j2"), kWide);
    CHECK(leader.count() == 2);
    CHECK(leader.held == std::vector<std::string>{"j2 stays at 0 (m follows it, which is above the base)",
                                                  "m stays at 0 (above the base)"});
    const ArmModel offset = armWith(kWide, kWide + mimicText("m", "offset='0.5'"));
    CHECK(offset.held.at(0) == "j2 stays at 0.5 (follows m)");
    CHECK(armWith(kWide, kWide).count() == 3);
}
