// SPDX-License-Identifier: Apache-2.0
// Commands for robots, and requests from other programs, as topics of a run.
#include "tests/ros2/fed_run.h"
#include "tests/ros2/robot.h"
#include "tests/ros2/topic_listener.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

using namespace fathom;

namespace {

const std::vector<Ros2Joint> kJoints{{"shoulder"}, {"rail", true}}; // at 0.5 rad and -0.25 m

// Says the line every few milliseconds until it holds.
template <class Holds>
bool sayUntil(Speaker& speaker, const std::string& line, Holds holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
        speaker.say(line);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        if (holds()) {
            return true;
        }
    }
    return false;
}

bool isNear(const Line& line, size_t word, double value) {
    return std::abs(line.number(word) - value) < 1e-6;
}

std::string outputFault(const std::string& request, const std::vector<Ros2Joint>& joints) {
    return testing::refusalOf([&] {
        openRos2Output(parseRos2OutputRequest(request + ",domain=" + std::to_string(testDomain())), joints);
    });
}

} // namespace

TEST_CASE(
    "A servo controller gets the tool's velocity in the base frame, and zero while an arm must stand still") {
    FedRun run("/fathom,frame=base_link,twist=/servo_node/delta_twist_cmds");
    run.each([](TickRow& row) {
        row.record.tool.position.x += 0.03 * row.record.t;
        row.record.tool.rotation =
            glm::angleAxis(0.5 * row.record.t, dvec3(0.0, 1.0, 0.0)) * row.record.tool.rotation;
    });
    TopicListener twist("/servo_node/delta_twist_cmds", "TwistStamped");
    const Line moves = twist.until([](const Line& line) { return isNear(line, 2, 0.03); });
    CHECK(moves.words(1, 1) == "base_link");
    CHECK(isNear(moves, 3, 0.0));
    CHECK(isNear(moves, 4, 0.0));
    CHECK(isNear(moves, 5, 0.0));
    CHECK(isNear(moves, 6, 0.5));
    CHECK(isNear(moves, 7, 0.0));
    run.change([](TickRow& row) { row.record.armHold = true; });
    CHECK(twist.until([](const Line& line) { return line.number(2) == 0.0; }).is("base_link 0 0 0 0 0 0"));
    for (int i = 0; i < 20; ++i) {
        CHECK(twist.next().words(2, 6) == "0 0 0 0 0 0");
    }
    run.change([](TickRow& row) { row.record.armHold = false; });
    CHECK(twist.until([](const Line& line) { return isNear(line, 2, 0.03); }).any());
}

TEST_CASE("The last velocity that a servo controller gets is zero") {
    auto run = std::make_unique<FedRun>("/fathom,twist=/twist");
    run->each([](TickRow& row) { row.record.tool.position.x += 0.03 * row.record.t; });
    TopicListener twist("/twist", "TwistStamped");
    REQUIRE(twist.until([](const Line& line) { return isNear(line, 2, 0.03); }).any());
    run.reset();
    CHECK(twist.until([](const Line& line) { return line.number(2) == 0.0; }).any());
}

TEST_CASE("A servo controller gets a zero velocity when the run stands still, and the motion after it") {
    FedRun run("/fathom,twist=/twist");
    std::atomic<bool> still{false};
    run.each([&](TickRow& row) {
        while (still) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        row.record.tool.position.x += 0.03 * row.record.t;
    });
    TopicListener twist("/twist", "TwistStamped");
    REQUIRE(twist.until([](const Line& line) { return isNear(line, 2, 0.03); }).any());
    still = true;
    Line last = twist.until([](const Line& line) { return line.number(2) == 0.0; });
    std::this_thread::sleep_for(std::chrono::seconds(1));
    while (twist.waiting()) { // of before, where a busy machine made a pause earlier
        last = twist.next();
    }
    CHECK(last.number(2) == 0.0);
    still = false;
    CHECK(twist.until([](const Line& line) { return isNear(line, 2, 0.03); }).any());
}

TEST_CASE("A robot gets joints only while its own are known and close to them") {
    FedRun run("/fathom,trajectory=/controller/joint_trajectory,measured=/joint_states", kJoints);
    TopicListener joints("/controller/joint_trajectory", "JointTrajectory"),
        diagnostics("/diagnostics", "DiagnosticArray");
    Robot robot;
    const auto reported = [&](const std::string& text) {
        return diagnostics.until([&](const Line& l) { return l.holds("fathom: robot " + text); }).any();
    };
    CHECK(reported("held: no measured joints"));
    robot.isAt("rail -0.25 shoulder 0.1");
    CHECK(reported("held: joint shoulder of the robot is elsewhere"));
    robot.isAt("rail -0.31 shoulder 0.5");
    CHECK(reported("held: joint rail of the robot is elsewhere"));
    robot.isAt("rail nan shoulder 0.5");
    CHECK(reported("held: no measured joints"));
    CHECK_FALSE(joints.waiting());
    robot.isAt("wheel 9 rail -0.25 shoulder 0.45");
    CHECK(reported("gets joints"));
    const Line sent = joints.next();
    CHECK(sent.stamp() == 0.0);
    CHECK(sent.is("base 0.008000000 shoulder 0.5 rail -0.25"));
    run.change([](TickRow& row) { row.record.armHold = true; });
    CHECK(reported("held: forces are off"));
    while (joints.waiting()) { // those of before
    }
    run.change([](TickRow& row) { row.record.armHold = false; });
    CHECK(joints.next().any());
    robot.isAt("");
    CHECK(reported("held: no measured joints"));
}

TEST_CASE("Joints that follow another one are neither awaited from the robot nor sent to it") {
    FedRun run("/fathom,trajectory=/trajectory,measured=/joint_states",
               {{"shoulder", false, true}, {"rail", true}});
    TopicListener joints("/trajectory", "JointTrajectory");
    Robot robot;
    robot.isAt("rail -0.25");
    CHECK(joints.next().is("base 0.008000000 rail -0.25"));
}

TEST_CASE("Frames of tool and camera are published if asked for") {
    FedRun run("/fathom,tf=on");
    TopicListener frames("/tf", "TFMessage");
    CHECK(frames.until([](const Line& line) { return line.holds("fathom_tool"); })
              .is("base fathom_tool 0.25 -0.5 0.75 0.5 0.5 0.5 0.5"));
    CHECK(frames.until([](const Line& line) { return line.holds("fathom_camera"); })
              .is("base fathom_camera 0 0.5 0 0 0 0 1"));
}

TEST_CASE("Other programs can switch forces off, guidance and freezing, but only where commands are on") {
    FedRun run("/fathom,commands=on");
    Speaker off("/fathom/forces_off", "Empty"), guidance("/fathom/guidance", "Bool"),
        freeze("/fathom/freeze", "Bool");
    CHECK_FALSE(run.observer().takeRequests().forcesOff);
    CHECK(sayUntil(off, "", [&] { return run.observer().takeRequests().forcesOff; }));
    CHECK(sayUntil(guidance, "1", [&] { return run.observer().takeRequests().guidance == true; }));
    CHECK(sayUntil(guidance, "0", [&] { return run.observer().takeRequests().guidance == false; }));
    CHECK(sayUntil(freeze, "1", [&] { return run.observer().takeRequests().frozen == true; }));
    CHECK_FALSE(run.observer().takeRequests().guidance.has_value());

    FedRun deaf("/deaf");
    Speaker unheard("/deaf/forces_off", "Empty");
    TopicListener wrench("/deaf/wrench", "WrenchStamped");
    bool obeyed = false;
    sayUntil(unheard, "", [&, n = 0]() mutable {
        obeyed = obeyed || deaf.observer().takeRequests().forcesOff;
        wrench.next();
        return ++n == 50;
    });
    CHECK_FALSE(obeyed);
}

TEST_CASE("A trajectory without an arm, or without measured joints, is refused") {
    CHECK(outputFault("/fathom,trajectory=/a,measured=/b", {})
              .find("--ros2: trajectory: /a (allowed: only with") == 0);
    CHECK(outputFault("/fathom,trajectory=/a", kJoints).find("--ros2: trajectory, measured: ") == 0);
    CHECK(outputFault("/fathom,measured=/b", kJoints).find("both or neither") != std::string::npos);
    CHECK(outputFault("/fathom,commands=off", kJoints).find("--ros2: commands: off (allowed: /PREFIX") == 0);
}
