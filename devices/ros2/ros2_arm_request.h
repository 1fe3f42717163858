// SPDX-License-Identifier: Apache-2.0
// A real arm whose joints are a topic of a ROS 2 graph, in one line: "ros2:joints=TOPIC[,NAME=VALUE]...".
#pragma once

#include "devices/ros2/ros2_place.h"

#include <string>

namespace fathom {

// The parsed line.
struct Ros2ArmRequest {
    Ros2Place place;
    std::string joints; // topic of sensor_msgs/msg/JointState
    double wait = 10.0; // [s] for the first posture

    static constexpr const char* kAllowed =
        "ros2:joints=TOPIC, then any of ,domain=N ,network=lo|INTERFACE|any ,wait=S";
};

// The domain is ros2Domain() if the text has none. Throws BadInput.
Ros2ArmRequest parseRos2ArmRequest(const std::string& text);

// Whether the text names such an arm, and no serial port.
bool isRos2Arm(const std::string& text);

} // namespace fathom
