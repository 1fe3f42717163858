// SPDX-License-Identifier: Apache-2.0
// The joints of a robot from messages of sensor_msgs/msg/JointState, without a network.
#include "devices/ros2/joint_readings.h"

#include "tests/devices/live_node.h"
#include "tests/realtime/listening.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// What a joint driver sends.
struct JointNode : LiveNode {
    double delay = 0.0; // [s] from stamp to arrival

    Ros2Message says(double stamp, const std::vector<std::string>& names,
                     const std::vector<double>& positions) const {
        return sends(ros2::jointState({nanoseconds(stamp), ""}, names, positions), stamp + delay);
    }
};

struct Robot {
    JointReadings joints{"test", "/joint_states", {{"slew", -2.0, 2.0}, {"rail"}}, {"finger"}};
    JointNode node;

    bool isAt(double slew, double rail) const {
        return joints.positions()[0] == slew && joints.positions()[1] == rail;
    }
    double age(double now) const { return joints.age(LiveNode::kBoot + now); }
};

} // namespace

TEST_CASE("Joints are found by their names, in any order, and may be spread over messages") {
    Robot robot;
    const Listening log;
    CHECK(std::isinf(robot.age(0.0)));
    CHECK(robot.joints.whyIncomplete() == "no message with joint slew, rail");
    robot.joints.take(robot.node.says(0.0, {"finger", "rail"}, {0.04, 0.5}));
    CHECK(std::isinf(robot.age(0.0)));
    CHECK(robot.joints.whyIncomplete() == "no message with joint slew");
    robot.joints.take(robot.node.says(0.1, {"slew"}, {-0.25}));
    CHECK(robot.isAt(-0.25, 0.5));
    CHECK(robot.age(0.3) == doctest::Approx(0.3)); // of the older one
    CHECK(log.count("test") == 0);
}

TEST_CASE("An unusable message of joints changes nothing, is counted, and is named once") {
    const std::vector<std::tuple<std::vector<std::string>, std::vector<double>, std::string>> kBroken{
        {{"rail", "slew"}, {0.1, std::nan("")}, "position of slew is not finite"},
        {{"rail", "slew"}, {0.1, INFINITY}, "position of slew is not finite"},
        {{"rail", "slew"}, {0.1, 2.03}, "joint slew: 2.030000 (allowed: -2.000000 to 2.000000)"},
        {{"rail", "slew", "rail"}, {0.1, 0.2, 0.3}, "joint rail twice"},
        {{"rail", "slew"}, {0.1}, "another number of positions than of names"}};
    for (const auto& [names, positions, fault] : kBroken) {
        const std::string& said = fault; // a lambda captures no structured binding
        CAPTURE(said);
        Robot robot;
        robot.joints.take(robot.node.says(0.0, {"slew", "rail"}, {1.0, 0.5}));
        const Listening log;
        for (int i = 1; i <= 3; ++i) {
            robot.joints.take(robot.node.says(0.1 * i, names, positions));
        }
        CHECK(robot.isAt(1.0, 0.5));
        CHECK(robot.joints.skipped() == 3);
        CHECK(robot.age(0.3) == doctest::Approx(0.3));
        CHECK(log.count("/joint_states: message skipped: " + fault) == 1);
        CHECK(robot.joints.whyIncomplete().find(fault) != std::string::npos);
    }
    Robot robot;
    const Listening log;
    const ros2::Message whole = ros2::jointState({1, ""}, std::vector<std::string>{"slew"}, std::array{0.5});
    for (size_t size = 0; size < whole.size(); ++size) { // velocities and efforts, which are not read, follow
        if (const ros2::Message part(whole.begin(), whole.begin() + static_cast<long>(size)); size < 44) {
            robot.joints.take(robot.node.sends(part, 0.0));
        }
    }
    CHECK(robot.joints.skipped() == 44);
    CHECK(log.count("truncated") == 1);
    ros2::Message absurd = whole;
    std::memset(absurd.data() + 20, 0xff, 4); // count of names
    robot.joints.take(robot.node.sends(absurd, 0.0));
    CHECK(log.count("4294967295 joints (allowed: at most 1000)") == 1);
}

TEST_CASE("Joints that the arm does not have, and joints that stay away, are named once") {
    Robot robot;
    const Listening log;
    for (int i = 0; i < 30; ++i) {
        robot.joints.take(robot.node.says(0.1 * i, {"wheel", "slew"}, {9.0, 0.5}));
    }
    CHECK(log.count("joint wheel is not of the arm and is ignored") == 1);
    CHECK(log.count("joint rail is missing") == 1);
    CHECK(log.count("joint slew") == 0);
    CHECK(std::isinf(robot.age(3.0)));
}

TEST_CASE("A joint slightly beyond its limit is at its limit") {
    Robot robot;
    robot.joints.take(robot.node.says(0.0, {"slew", "rail"}, {-2.015, 100.0}));
    CHECK(robot.isAt(-2.0, 100.0));
}

TEST_CASE(
    "The age of a posture is that of its stamp, and of its arrival where stamps are from another clock") {
    Robot robot;
    robot.node.delay = 0.4;
    robot.joints.take(robot.node.says(0.0, {"slew", "rail"}, {0.0, 0.0}));
    CHECK(robot.age(0.4) == doctest::Approx(0.4));
    Robot simulated;
    simulated.node.delay = 5000.0;
    simulated.joints.take(simulated.node.says(0.0, {"slew", "rail"}, {0.0, 0.0}));
    CHECK(simulated.age(5000.1) == doctest::Approx(0.1));
    Robot unstamped;
    for (const double arrival : {1.0, 2.0}) {
        unstamped.joints.take(unstamped.node.sends(
            ros2::jointState({0, ""}, std::vector<std::string>{"slew", "rail"}, std::array{0.5, arrival}),
            arrival));
        CHECK(unstamped.age(arrival) == 0.0);
        CHECK(unstamped.isAt(0.5, arrival));
    }
}

TEST_CASE("A clock that stands still or jumps back does not make a posture newer") {
    Robot robot;
    const Listening log;
    robot.joints.take(robot.node.says(1.0, {"slew", "rail"}, {0.5, 0.0}));
    for (int i = 0; i < 20; ++i) { // the node repeats itself
        robot.node.delay += 0.1;
        robot.joints.take(robot.node.says(1.0, {"slew", "rail"}, {0.7, 0.0}));
    }
    CHECK(robot.isAt(0.5, 0.0));
    CHECK(robot.age(3.0) == doctest::Approx(2.0));
    CHECK(log.count("a stamp is not later than the one before (logged once)") == 1);
    robot.node.delay = 0.6; // older than what is known
    for (int i = 0; i < 6; ++i) {
        robot.joints.take(robot.node.says(0.3 + 0.01 * i, {"slew", "rail"}, {0.7, 0.0}));
    }
    CHECK(robot.isAt(0.5, 0.0));
    robot.node.delay = 100.0; // set back by 97 s: the fifth message counts
    for (int i = 0; i < 5; ++i) {
        CHECK(robot.isAt(0.5, 0.0));
        robot.joints.take(robot.node.says(-97.0 + 0.1 * i, {"slew", "rail"}, {0.9, 0.0}));
    }
    CHECK(robot.isAt(0.9, 0.0));
}

TEST_CASE("Joints of a second publisher are ignored while the first one sends") {
    Robot robot;
    const Listening log;
    const JointNode other{{2}}, wheels{{3}};
    robot.joints.take(wheels.says(0.0, {"wheel"}, {1.0})); // does not count as the first one
    robot.joints.take(robot.node.says(0.1, {"slew", "rail"}, {0.5, 0.0}));
    robot.joints.take(other.says(0.2, {"slew", "rail"}, {0.7, 0.0}));
    CHECK(robot.isAt(0.5, 0.0));
    CHECK(log.count("/joint_states has a second publisher") == 1);
    robot.joints.take(other.says(1.2, {"slew", "rail"}, {0.7, 0.0}));
    CHECK(robot.isAt(0.7, 0.0));
}
