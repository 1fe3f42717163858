// SPDX-License-Identifier: Apache-2.0
// Reads what haptic devices and robots of ROS 2 publish. Untrusted input.
#pragma once

#include "engine/types/pose.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace fathom::ros2 {

// A pose of the handle in the frame that the node names.
struct HandPose {
    std::string frame;
    Pose pose; // [m]; the rotation is of unit length
};

// geometry_msgs/msg/PoseStamped in CDR. Throws Error: truncated, a number that is not finite, a position
// beyond kFarthestHand, a rotation that is not of unit length within kUnitSlack.
HandPose handPose(std::span<const uint8_t> message);

// Limits of a pose.
inline constexpr double kFarthestHand = 10.0; // [m] from the origin of the device frame
// Of a rotation's length.
inline constexpr double kUnitSlack = 0.05;

// The buttons of sensor_msgs/msg/Joy in CDR, true while down. Throws Error: truncated, or more than kMaxJoy
// axes or buttons.
std::vector<bool> joyButtons(std::span<const uint8_t> message);

// Limit of axes and of buttons.
inline constexpr uint32_t kMaxJoy = 256;

// Positions of sensor_msgs/msg/JointState in CDR, [rad] or [m]. Throws Error: truncated, more than
// kMaxJoints, another count of positions than of names, or a position that is not finite.
std::vector<std::pair<std::string, double>> jointPositions(std::span<const uint8_t> message);

// Limit of joints.
inline constexpr uint32_t kMaxJoints = 1000;

} // namespace fathom::ros2
