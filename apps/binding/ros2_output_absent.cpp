// SPDX-License-Identifier: Apache-2.0
// Replaces ros2_arm.cpp and ros2_output.cpp in builds without Cyclone DDS.
#include "apps/binding/ros2_arm.h"
#include "apps/binding/ros2_output.h"

#include "devices/ros2/open_ros2.h"
#include "engine/types/error.h"

namespace fathom {

std::unique_ptr<ArmLine> openRos2Arm(const Ros2ArmRequest& request, const ArmModel&) {
    throw BadInput("--arm", "ros2", request.joints, kWithoutRos2);
}

std::unique_ptr<RunObserver> openRos2Output(const Ros2OutputRequest& request, const std::vector<Ros2Joint>&) {
    throw BadInput("--ros2", "PREFIX", request.prefix, kWithoutRos2);
}

} // namespace fathom
