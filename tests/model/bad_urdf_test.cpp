// SPDX-License-Identifier: Apache-2.0
// What is wrong with a robot is said in one line that names the file.
#include "engine/model/arm_warnings.h"
#include "tests/model/urdf_text.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

bool reportsOnly(const std::string& refusal, const std::string& words) {
    INFO(refusal);
    CHECK(refusal.find(".urdf: ") != std::string::npos);
    CHECK(refusal.find('\n') == std::string::npos);
    return refusal.find(words) != std::string::npos;
}

std::string withLimit(const std::string& limit) {
    return ballLink("a") + ballLink("b") + jointText("j", "revolute", "a", "b", "0 0 0", "0 0 1", limit);
}

} // namespace

TEST_CASE("Two roots, circles, limits that are crossed or no numbers, and too many links are rejected in one "
          "line") {
    CHECK(reportsOnly(urdfRefusal(ballLink("a") + ballLink("b")), "root"));
    CHECK(reportsOnly(urdfRefusal(ballLink("a") + ballLink("b") +
                                  jointText("j", "revolute", "a", "b", "0 0 0", "0 0 1") +
                                  jointText("k", "revolute", "b", "a", "0 0 0", "0 0 1")),
                      "root"));
    CHECK(reportsOnly(urdfRefusal(withLimit("<limit lower='1' upper='-1' velocity='1' effort='1'/>")),
                      "joint j: lower 1, upper -1 (allowed: lower <= upper)"));
    for (const char* limit : {"lower='nan' upper='1'", "lower='0' upper='many'", "lower='-3,14' upper='1'"}) {
        CHECK(
            reportsOnly(urdfRefusal(withLimit("<limit " + std::string(limit) + " velocity='1' effort='1'/>")),
                        "(allowed: a finite number, such as -1.5)"));
    }
    for (const char* axis : {"0,1,0", "0 1"}) {
        CHECK(reportsOnly(urdfRefusal(ballLink("a") + ballLink("b") +
                                      jointText("j", "continuous", "a", "b", "0 0 0", axis)),
                          "numbers with spaces between, such as \"0 0 1.5\")"));
    }
    CHECK(reportsOnly(urdfRefusal(withLimit("")), "(allowed: "));
    std::string many;
    for (int i = 0; i < 50'000; ++i) {
        many += "<link name='";
        many += std::to_string(i);
        many += "'/>";
    }
    CHECK(reportsOnly(urdfRefusal(many), "(allowed: "));
    CHECK(reportsOnly(urdfRefusal(many + std::string(16u << 20, ' ')), "16 MiB"));
}

TEST_CASE(
    "A fault of a joint names the joint, and an expression of xacro names the command that resolves it") {
    const auto joint = [](const std::string& at, const std::string& more) {
        return ballLink("a") + ballLink("b") + jointText("elbow", "revolute", "a", "b", at, "0 0 1", more);
    };
    const std::string limit = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";
    for (const std::string& text : {joint("0 0 nan", limit), joint("0 0", limit),
                                    joint("0 0 1", "<limit lower='-1,5' upper='1' velocity='1' effort='1'/>"),
                                    joint("0 0 1", "<limit lower='-1' upper='1' velocity='x' effort='1'/>"),
                                    joint("0 0 1", "<limit lower='-1' upper='1' velocity='nan'/>"),
                                    joint("0 0 1", limit + mimicText("a", "multiplier='x'"))}) {
        CHECK(reportsOnly(urdfRefusal(text), "oint [elbow]"));
    }
    for (const std::string& text : {joint("0 0 ${height}", limit), joint("0 0 $(arg height)", limit),
                                    ballLink("$(arg prefix)a"), ballLink("a", "${2 * r}")}) {
        CHECK(reportsOnly(urdfRefusal(text), "expand it with: xacro"));
    }
    CHECK(urdfRefusal(joint("0 0 1", limit) +
                      "<gazebo><plugin><joint>${j}</joint><link name='${l}'/></plugin></gazebo>") == "");
}

TEST_CASE("Joints that cannot move, and limits that look like degrees, are reported in one line each") {
    const auto notes = [](const std::string& type, const std::string& limits) {
        const std::string limit = "<limit effort='1' velocity='1' " + limits + "/>";
        return loadUrdf(ballLink("a") + ballLink("b") +
                        jointText("j", type, "a", "b", "0 0 0", "0 0 1", limit))
            .notes;
    };
    const auto stuck = notes("revolute", "");
    REQUIRE(stuck.size() == 1);
    CHECK(stuck[0] ==
          "joint j: limits 0 to 0 rad: it cannot move; they are 0 where <limit> has no lower and upper");
    CHECK(notes("prismatic", "lower='0.1' upper='0.1'") ==
          std::vector<std::string>{"joint j: limits 0.1 to 0.1 m: it cannot move"});
    CHECK(notes("revolute", "lower='-180' upper='180'") ==
          std::vector<std::string>{"joint j: limits -180 to 180 rad span more than four turns; in degrees?"});
    CHECK(notes("revolute", "lower='-6.3' upper='6.3'").empty());
    CHECK(notes("continuous", "").empty());
    const auto guarded = [](const std::string& soft) {
        return loadUrdf(ballLink("a") + ballLink("b") +
                        jointText("j", "revolute", "a", "b", "0 0 0", "0 0 1",
                                  "<limit effort='1' velocity='1' lower='-2' upper='2'/><safety_controller "
                                  "k_velocity='1' " +
                                      soft + "/>"))
            .notes;
    };
    CHECK(guarded("soft_lower_limit='-2' soft_upper_limit='2'").empty());
    CHECK(guarded("").empty());
    CHECK(guarded("soft_lower_limit='-1' soft_upper_limit='2'") ==
          std::vector<std::string>{
              "joint j: the narrower limits of <safety_controller> are not read; arm.joints sets limits"});
    CHECK(notes("prismatic", "lower='0' upper='300'") ==
          std::vector<std::string>{
              "joint j: limits 0 to 300 m span more than 5 m; in millimetres, or without limits?"});
}

TEST_CASE("Speeds, fingers and held joints that look like degrees or millimetres are questioned") {
    const auto arm = [](const std::string& type, const std::string& limits) {
        return loadUrdf(
            ballLink("a") + ballLink("b") +
            jointText("j", type, "a", "b", "0 0 0", "0 0 1", "<limit effort='1' " + limits + "/>"));
    };
    const ArmModel degrees = arm("revolute", "lower='-2' upper='2' velocity='180'");
    CHECK(degrees.notes == std::vector<std::string>{"joint j: speed 180 rad/s; in degrees per second?"});
    CHECK(degrees.joints[0].speed == 100.0);
    CHECK(degrees.joints[0].speedFrom == "file, but at most this");
    CHECK(arm("revolute", "lower='-2' upper='2' velocity='12'").notes.empty());
    CHECK(arm("prismatic", "lower='0' upper='0.5' velocity='250'").notes ==
          std::vector<std::string>{"joint j: speed 250 m/s; in millimetres per second?"});
    CHECK(limitWarning("f", true, 0.0, 0.04, kLongFinger) == "");
    CHECK(limitWarning("f", true, 0.0, 40.0, kLongFinger) ==
          "joint f: limits 0 to 40 m span more than 0.5 m; in millimetres, or without limits?");
    CHECK(heldWarning("f", true, 10.0) == "joint f: stays at 10 m; in millimetres?");
    CHECK(heldWarning("f", true, -0.3) == "");
    CHECK(heldWarning("f", false, 90.0) == "joint f: stays at 90 rad; in degrees?");
}

TEST_CASE("A file of MoveIt or SDF in place of a URDF is named as such, with what to give instead") {
    const std::string groups = "<group name='arm'><chain base_link='a' tip_link='b'/></group>"
                               "<disable_collisions link1='a' link2='b' reason='Never'/>";
    const std::string srdf = urdfRefusal(groups);
    CHECK(reportsOnly(srdf, "robot: an SRDF of MoveIt, without links and joints (allowed: the URDF that it "
                            "belongs to)"));
    CHECK(reportsOnly(urdfRefusal("<!-- <link name='a'/> -->" + groups), "an SRDF of MoveIt"));
    CHECK_FALSE(reportsOnly(urdfRefusal("<group name='arm'/>" + withLimit("")), "SRDF"));
    CHECK_FALSE(reportsOnly(urdfRefusal(""), "SRDF"));
    const ScratchFile sdf("arm.urdf", "<?xml version='1.0'?><sdf version='1.7'><model name='r'/></sdf>");
    CHECK(reportsOnly(refusalOf([&] { loadArm(sdf.path(), {}); }), "robot: an SDF (allowed: a URDF or MJCF"));
}

TEST_CASE("A capsule without a length and a mesh without a file name are named as such, with their link") {
    const auto link = [](const std::string& shape) {
        return "<link name='arm'><collision><geometry>" + shape + "</geometry></collision></link>";
    };
    CHECK(
        reportsOnly(urdfRefusal(link("<capsule radius='0.02' height='0.1'/>")),
                    "link arm: a capsule without length (allowed: <capsule radius=\"r\" length=\"l\"/> [m]"));
    CHECK(reportsOnly(urdfRefusal(link("<capsule length='0.1'></capsule>")),
                      "link arm: a capsule without radius"));
    CHECK(urdfRefusal(link("<capsule radius='0.02' length='0.1'/>") + ballLink("b") +
                      jointText("j", "revolute", "arm", "b", "0 0 0", "0 0 1")) == "");
    CHECK(reportsOnly(urdfRefusal(link("<mesh filename=''/>")), "link arm: a mesh without a file name"));
}

TEST_CASE("Limits, types and versions that the parser rejects come with what is allowed") {
    CHECK(reportsOnly(urdfRefusal(withLimit("")),
                      "(allowed: <limit lower=\"l\" upper=\"u\"/> [rad], [m]; type=\"continuous\" for"));
    CHECK(reportsOnly(
        urdfRefusal(ballLink("a") + ballLink("b") + jointText("j", "Revolute", "a", "b", "0 0 0", "0 0 1")),
        "(allowed: revolute, continuous, prismatic, fixed, planar, floating, in small letters)"));
    const auto robot = [](const std::string& attributes) {
        const ScratchFile file("arm.urdf", "<robot " + attributes + ">" + ballLink("a") + "</robot>");
        return refusalOf([&] { loadArm(file.path(), {}); });
    };
    CHECK(reportsOnly(robot("name='r' version='2.0'"), "(allowed: <robot version=\"1.0\">, or no version)"));
    CHECK(reportsOnly(robot(""), "(allowed: <robot name=\"n\">)"));
}

TEST_CASE("A negative speed counts as none, with a note that states it") {
    const ArmModel arm = loadUrdf(withLimit("<limit lower='-1' upper='1' velocity='-2' effort='1'/>"));
    CHECK(arm.joints[0].speed == kUnknownTurn);
    CHECK(arm.notes ==
          std::vector<std::string>{"joint j: the file states a speed of -2, which counts as none"});
}

TEST_CASE("Values of a limit that are not read, infinite speeds and missing ones do not reject a URDF") {
    const auto jointOf = [](const std::string& type, const std::string& limit) {
        return loadUrdf(ballLink("a") + ballLink("b") +
                        jointText("j", type, "a", "b", "0 0 0", "0 0 1", "<limit " + limit + "/>"));
    };
    for (const char* limit :
         {"lower='-inf' upper='inf' effort='inf' velocity='inf'", "lower='-inf' upper='inf'",
          "lower=' -Infinity ' upper=\"+INF\" effort='1' velocity='1e999'", ""}) {
        const ArmModel arm = jointOf("continuous", limit); // the first one as Isaac Sim exports it
        CAPTURE(limit);
        CHECK(std::isinf(arm.joints[0].upper));
        CHECK(arm.joints[0].speed == kUnknownTurn);
        CHECK(arm.joints[0].speedFrom == kDefaultSpeedSource);
        CHECK(arm.notes.empty());
    }
    for (const char* effort : {"", " effort='inf'", " effort='strong'"}) {
        const ArmModel arm = jointOf("revolute", std::string("lower='-1' upper='2' velocity='0.5'") + effort);
        CAPTURE(effort);
        CHECK(arm.joints[0].lower == -1.0);
        CHECK(arm.joints[0].upper == 2.0);
        CHECK(arm.joints[0].speed == 0.5);
    }
    const ArmModel slide = jointOf("prismatic", "lower='0' upper='2' effort='inf' velocity='inf'");
    CHECK(slide.joints[0].upper == 2.0);
    CHECK(slide.joints[0].speed == kUnknownSlide);
    CHECK(slide.joints[0].speedFrom == kDefaultSpeedSource);
    CHECK(urdfRefusal(withLimit("<limit lower='-1' upper='1' velocity='1' effort='1'/>") + ballLink("c") +
                      jointText("f", "fixed", "b", "c", "0 0 0", "0 0 1",
                                "<limit lower='-inf' upper='inf'/>")) == "");
}

TEST_CASE(
    "An infinite limit of a joint that needs finite ones is rejected with the joint and what is allowed") {
    const std::string allowed =
        " (allowed: finite numbers; type=\"continuous\" for a joint that turns without limits)";
    CHECK(reportsOnly(urdfRefusal(withLimit("<limit lower='-inf' upper='1' velocity='1' effort='1'/>")),
                      "joint j: limit lower=\"-inf\"" + allowed));
    CHECK(reportsOnly(urdfRefusal(ballLink("a") + ballLink("b") +
                                  jointText("rail", "prismatic", "a", "b", "0 0 0", "0 0 1",
                                            "<limit velocity='inf' lower='0' upper='Infinity'/>")),
                      "joint rail: limit upper=\"Infinity\"" + allowed));
}
