// SPDX-License-Identifier: Apache-2.0
// A haptic device whose poses and forces are topics of a ROS 2 graph, in one line:
// "pose=TOPIC[,NAME=VALUE]...".
#pragma once

#include "devices/ros2/ros2_place.h"

#include <optional>
#include <string>

namespace fathom {

// The parsed line.
struct Ros2HandRequest {
    Ros2Place place;
    std::string pose;                  // geometry_msgs/msg/PoseStamped of the handle, device frame
    std::string wrench;                // geometry_msgs/msg/WrenchStamped, published: the force to render
    std::string joy;                   // sensor_msgs/msg/Joy; empty = no buttons
    std::string preset = "none";       // of engine/haptics/device_preset.h
    uint32_t guidance = 0, clutch = 1; // buttons of joy
    std::optional<uint32_t> deadMan;   // button of joy without which there is no force

    static constexpr const char* kAllowed =
        "pose=TOPIC, then any of ,wrench=TOPIC ,joy=TOPIC ,preset=NAME ,guidance=BUTTON ,clutch=BUTTON "
        ",dead_man=BUTTON ,domain=N ,network=lo|INTERFACE|any";
};

// The wrench's topic is that of the pose with "/wrench" as last part if the text has none. Throws BadInput.
Ros2HandRequest parseRos2HandRequest(const std::string& text);

} // namespace fathom
