// SPDX-License-Identifier: Apache-2.0
// A real arm whose posture is a topic of ROS 2.
#include "apps/binding/arm_thread.h"
#include "apps/binding/ros2_arm.h"
#include "engine/types/error.h"
#include "tests/haptics/arm_proxy_world.h"
#include "tests/ros2/robot.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

const std::string kJointTopic = "/joint_states";

// Joints "0", "1" and "2"; the last one follows the first.
ArmModel mimicArm() {
    ArmModel arm = fathom::testing::makeArm(3, 1);
    arm.joints[2].mimic = ArmMimic{0, -0.5, 0.1};
    return arm;
}

ArmThread::Target armTarget(const ArmModel& arm, const std::string& wait = "60") {
    const std::string text =
        "ros2:joints=" + kJointTopic + ",domain=" + std::to_string(testDomain()) + ",wait=" + wait;
    return {text, "arm", [text, arm] { return openRos2Arm(parseRos2ArmRequest(text), arm); }};
}

// The thread of the arm, once it is ready.
struct MeasuredArm {
    explicit MeasuredArm(const std::string& joints) {
        robot.isAt(joints);
        start = thread.ready(stop);
    }
    // Whether the arm's state becomes this one, while the engine asks it to stay at its start.
    bool becomes(const std::function<bool(const ArmStatus&)>& wanted) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (std::chrono::steady_clock::now() < end) {
            thread.link().setpoint.back() = {start, false, false, std::chrono::steady_clock::now()};
            thread.link().setpoint.publish();
            thread.link().status.refresh();
            if (wanted(thread.link().status.front())) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }

    ArmModel model = mimicArm();
    Robot robot;
    std::atomic<bool> stop{false};
    ArmThread thread{armTarget(model), model.joints, chainAxes(model)};
    ArmPosture start;
};

bool isPosture(const ArmStatus& status, double first, double second) {
    const JointVector& q = status.posture.q;
    return status.known && q[0] == first && q[1] == second && q[2] == 0.1 - 0.5 * first;
}

std::string requestFault(const std::string& text) {
    return testing::refusalOf([&] { parseRos2ArmRequest(text); });
}

} // namespace

TEST_CASE("An arm starts and follows where its JointState topic says, with the joints that follow others") {
    MeasuredArm arm("age=0 wheel 9 1 0.25 0 0.5");
    CHECK(arm.start.q[0] == 0.5);
    CHECK(arm.start.q[1] == 0.25);
    CHECK(arm.start.q[2] == -0.15);
    CHECK(arm.becomes([](const ArmStatus& s) { return s.state == ArmState::Follows; }));
    arm.robot.isAt("age=0 0 0.625 1 0.25");
    CHECK(arm.becomes([](const ArmStatus& s) { return isPosture(s, 0.625, 0.25); }));
    CHECK(arm.thread.link().measured.nearest(std::chrono::steady_clock::now())->q[0] == 0.625);
}

TEST_CASE("An arm that is far from its setpoint for half a second is behind, until it is back") {
    MeasuredArm arm("age=0 0 0.5 1 0.25");
    arm.robot.isAt("age=0 0 1 1 0.25");
    CHECK(arm.becomes([](const ArmStatus& s) { return s.state == ArmState::Behind; }));
    arm.robot.isAt("age=0 0 0.5 1 0.25");
    CHECK(arm.becomes([](const ArmStatus& s) { return s.state == ArmState::Follows; }));
}

TEST_CASE("A bad joint does not move the arm; bad, old and missing messages make it silent until good ones "
          "come") {
    MeasuredArm arm("age=0 0 0.5 1 0.25");
    for (const std::string bad :
         {"age=0 0 nan 1 0.25", "age=0 0 1.3 1 0.25", "age=0 0 0.25", "age=0.6 0 0.25 1 0.25", "short", ""}) {
        CAPTURE(bad);
        arm.robot.isAt(bad);
        bool moved = false;
        CHECK(arm.becomes([&](const ArmStatus& s) {
            moved = moved || (s.known && s.posture.q[0] != 0.5);
            return s.state == ArmState::Silent && !s.known;
        }));
        CHECK((!moved || bad == "age=0 0 0.25")); // the other joint is then missing
        arm.robot.isAt("age=0 0 0.5 1 0.25");
        CHECK(arm.becomes(
            [](const ArmStatus& s) { return s.state == ArmState::Follows && s.posture.q[0] == 0.5; }));
    }
}

TEST_CASE("An arm without a topic of all its joints is refused with what is missing") {
    const ArmModel model = mimicArm();
    const std::atomic<bool> stop{false};
    const auto refused = [&] {
        ArmThread thread(armTarget(model, "2"), model.joints, chainAxes(model));
        return testing::refusalOf<DeviceLost>([&] { thread.ready(stop); });
    };
    CHECK(refused().find("arm: no message with joint 0, 1 in domain " + std::to_string(testDomain())) == 0);
    const auto becomes = [&](const std::string& joints, const std::string& part) { // once it is found
        Robot robot;
        robot.isAt(joints);
        std::string said = refused();
        for (int i = 0; i < 20 && said.find(part) == std::string::npos; ++i) {
            said = refused();
        }
        CHECK_MESSAGE(said.find(part) != std::string::npos, said);
    };
    becomes("age=0 0 0.5", "no message with joint 1 in");
    becomes("age=0 0 0.5", "/joint_states (sensor_msgs/msg/JointState)");
    becomes("age=0 0 3 1 0", "joint 0: 3.000000 (allowed: -1.200000 to 1.200000)");
}

TEST_CASE("A request for an arm needs a topic and knows no other words") {
    CHECK(requestFault("ros2:").find("--arm: ros2: ros2: (allowed: ros2:joints=TOPIC") == 0);
    CHECK(requestFault("ros2").find("ros2:joints=TOPIC") != std::string::npos);
    CHECK(requestFault("ros2:joints=/a,speed=1").find("ros2:joints=TOPIC") != std::string::npos);
    CHECK(requestFault("ros2:joints=/a b").find("--arm: joints: /a b") == 0);
    CHECK(requestFault("ros2:joints=/a,domain=300").find("--arm: domain: 300 (allowed: 0 to 232)") == 0);
    CHECK(requestFault("ros2:joints=/a,wait=0").find("--arm: wait: 0 (allowed: a number above 0") == 0);
    CHECK(parseRos2ArmRequest("ros2:joints=a").joints == "/a");
    CHECK(isRos2Arm("ros2:joints=/a"));
    CHECK_FALSE(isRos2Arm("/dev/ttyUSB0"));
}
