// SPDX-License-Identifier: Apache-2.0
// Cameras of a ROS 2 graph through Eclipse Cyclone DDS, when built with it.
#pragma once

#include "devices/camera.h"

#include <limits>
#include <memory>
#include <string>

namespace fathom {

// What is allowed in builds without Cyclone DDS.
inline constexpr const char* kWithoutRos2 =
    "none: this program was built without Cyclone DDS (install cyclonedds-dev and rebuild)";

// "ros2:depth=TOPIC,..." (ros2_request.h).
bool isRos2Request(const std::string& source);

// everyFrame: deliver every frame in order, not only the newest. farthest [m]: readings beyond do not matter.
// Throws BadInput: not built in, an invalid request, or no usable images within the time allowed.
std::unique_ptr<Camera> openRos2(const std::string& source, bool everyFrame,
                                 double farthest = std::numeric_limits<double>::infinity());

} // namespace fathom
