// SPDX-License-Identifier: Apache-2.0
// A real arm whose posture is a topic of ROS 2. It is only measured here: other topics move it, such as the
// trajectory of ros2_servo.h.
#pragma once

#include "apps/binding/arm_line.h"
#include "devices/ros2/ros2_arm_request.h"
#include "engine/model/arm_model.h"

#include <memory>

namespace fathom {

// Its axes are those of chainAxes(). Joints are found by their names. Those that follow another joint are
// computed from it. The posture is stale once its oldest joint is 0.25 s old. Throws BadInput: no Cyclone
// DDS, no such network, or this program takes part through another one.
std::unique_ptr<ArmLine> openRos2Arm(const Ros2ArmRequest& request, const ArmModel& model);

} // namespace fathom
