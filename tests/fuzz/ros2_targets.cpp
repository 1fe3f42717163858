// SPDX-License-Identifier: Apache-2.0
// Targets for messages of ROS 2 that are not of cameras.
#include "devices/ros2/joint_readings.h"
#include "devices/ros2/live_transforms.h"
#include "devices/ros2/received_messages.h"
#include "tests/devices/live_node.h"
#include "tests/fuzz/fuzz_target.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::testing {

namespace {

void readTransforms(Bytes message) {
    LiveTransforms transforms("fuzz");
    transforms.take(LiveNode().sends({message.begin(), message.end()}, 0.0), false);
    const LiveTransforms::Answer answer = transforms.pose("camera", "base", 1.0);
    need(answer.pose ? isFinite(*answer.pose) : !answer.why.empty());
}

void readJoints(Bytes message) {
    need(ros2::jointPositions(message).size() <= ros2::kMaxJoints);
    JointReadings joints("fuzz", "/joint_states", {{"elbow", -1.0, 1.0}});
    joints.take(LiveNode().sends({message.begin(), message.end()}, 0.0));
    const double elbow = joints.positions()[0];
    need(std::isnan(elbow) || std::abs(elbow) <= 1.0);
}

} // namespace

// The first byte selects a pose, buttons, joints or transforms.
void readRos2Hand(Bytes input) {
    if (input.empty()) {
        return;
    }
    if (input[0] % 4 == 3) {
        readTransforms(input.subspan(1));
    } else if (input[0] % 4 == 0) {
        const ros2::HandPose hand = ros2::handPose(input.subspan(1));
        need(isFinite(hand.pose) && std::abs(glm::length(hand.pose.rotation) - 1.0) < 1e-9);
        need(glm::length(hand.pose.position) <= ros2::kFarthestHand);
    } else if (input[0] % 4 == 2) {
        readJoints(input.subspan(1));
    } else {
        need(ros2::joyButtons(input.subspan(1)).size() <= ros2::kMaxJoy);
    }
}

} // namespace fathom::testing
