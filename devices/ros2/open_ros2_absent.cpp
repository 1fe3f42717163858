// SPDX-License-Identifier: Apache-2.0
// Replaces open_ros2.cpp in builds without Cyclone DDS.
#include "devices/ros2/open_ros2.h"
#include "devices/ros2/ros2_bridge.h"
#include "engine/types/error.h"

namespace fathom {

std::unique_ptr<Camera> openRos2(const std::string& source, bool, double) {
    throw BadInput("--source", "ros2", source, kWithoutRos2);
}

std::unique_ptr<Ros2Bridge> openRos2Bridge(const Ros2HandRequest& request, const std::filesystem::path&,
                                           double, double) {
    throw BadInput("guard", "ros2", request.pose, kWithoutRos2);
}

} // namespace fathom
