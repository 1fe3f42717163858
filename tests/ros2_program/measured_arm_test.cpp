// SPDX-License-Identifier: Apache-2.0
// The whole program with a robot of ROS 2: its joints come from a topic, and a trajectory moves it.
#include "tests/rig/arm_stage.h"
#include "tests/ros2/robot.h"
#include "tests/ros2/topic_listener.h"

#include <doctest/doctest.h>
#include <future>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string place() {
    return ",domain=" + std::to_string(testDomain());
}

// A robot that is wherever the trajectory puts it.
struct FollowingRobot {
    FollowingRobot()
        : trajectory(ROS2_LISTENER, {std::to_string(testDomain()), "/robot/trajectory", "JointTrajectory"}) {
        REQUIRE(trajectory.line() == "ready");
        robot.isAt(joints);
    }
    // Until the run has ended or `done` says so.
    template <class Done>
    void follow(std::future<ProgramRun>& run, Done done) {
        while (run.wait_for(std::chrono::seconds(0)) != std::future_status::ready && !done()) {
            if (const auto text = trajectory.line(std::chrono::seconds(1))) {
                const Line line(*text);
                joints = "age=0 " + line.words(3, 6); // names and positions
                q = {line.number(4), line.number(6), line.number(8)};
                robot.isAt(joints);
            }
        }
    }

    std::array<double, 3> q{kStart[0], kStart[1], kStart[2]};
    std::string joints = "age=0 slew " + std::to_string(q[0]) + " shoulder " + std::to_string(q[1]) +
                         " elbow " + std::to_string(q[2]);
    Robot robot;
    Peer trajectory;
};

std::future<ProgramRun> startReplay(const Stage& stage) {
    return std::async(std::launch::async, [&] {
        return runFathom(
            stage.command({"--realtime", "--arm", "ros2:joints=/joint_states,wait=60" + place(), "--ros2",
                           "/fathom,trajectory=/robot/trajectory,measured=/joint_states" + place()}));
    });
}

nlohmann::json armSummary(const Stage& stage) {
    return nlohmann::json::parse(stage.read("out/summary.json")).at("arm").at("driven");
}

} // namespace

TEST_CASE("A robot of ROS 2 follows the tool up to a region, from where its joints are") {
    const Stage stage;
    setUp(stage, kReach, pushing(4.5));
    FollowingRobot robot;
    auto running = startReplay(stage);
    robot.follow(running, [] { return false; });
    const ProgramRun run = running.get();
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.out.find("real arm     ROS 2 /joint_states") != std::string::npos);
    CHECK(armSummary(stage).at("turns").at("follows").get<uint64_t>() > 1000);
    constexpr double kSurfaceDepth = 0.54; // [m] z of the tip's centre in contact with the region
    CHECK(tipDepth(robot.q) < kSurfaceDepth + 0.001);
    CHECK(tipDepth(robot.q) > kSurfaceDepth - 0.01);
}

TEST_CASE("A robot whose joints stop is silent: tool and robot stand still, and both resume afterwards") {
    const Stage stage;
    setUp(stage, kReach, {{0.0, {0, 0, 0}}, {0.3, {0, 0, 0}}, {15.0, {0, 0, 0.11}}});
    FollowingRobot robot;
    TopicListener diagnostics("/diagnostics", "DiagnosticArray");
    auto running = startReplay(stage);
    const auto depth = [&] { return tipDepth(robot.q); };
    const double start = depth();
    robot.follow(running, [&] { return depth() > start + 0.003; });
    const double before = depth();
    robot.robot.isAt("age=0 slew nan shoulder 1 elbow 1");
    CHECK(diagnostics.until([](const Line& line) { return line.holds("fathom: arm silent"); }).any());
    robot.robot.isAt(robot.joints);
    robot.follow(running, [] { return false; });
    const ProgramRun run = running.get();
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.err.find("position of slew is not finite (logged once)") != std::string::npos);
    CHECK(run.err.find("ROS 2 /joint_states: silent") != std::string::npos);
    CHECK(armSummary(stage).at("turns").at("silent").get<uint64_t>() > 0);
    CHECK(depth() > before + 0.005);
}

TEST_CASE("A robot of ROS 2 needs a scene with an arm, a realtime run and joints that come") {
    const Stage stage;
    setUp(stage, kReach, pushing(1.0));
    const auto refused = [&](const std::vector<std::string>& more, int exitCode, const std::string& part) {
        const ProgramRun run = runFathom(stage.command(more));
        CHECK(run.exitCode == exitCode);
        CHECK_MESSAGE(run.err.find(part) != std::string::npos, run.err);
    };
    refused({"--arm", "ros2:joints=/a"}, 2, "--arm: ros2:joints=/a (allowed: together with --realtime)");
    refused({"--realtime", "--arm", "ros2:topic=/a"}, 2,
            "--arm: ros2: ros2:topic=/a (allowed: ros2:joints=TOPIC");
    refused({"--realtime", "--arm", "ros2:joints=/nothing,wait=2" + place()}, 3,
            "ROS 2 /nothing: no message with joint slew, shoulder, elbow in domain");
    stage.scene({});
    refused({"--realtime", "--arm", "ros2:joints=/a"}, 2, "an arm, because of --arm ros2:joints=/a");
}
