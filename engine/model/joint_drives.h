// SPDX-License-Identifier: Apache-2.0
// What moves each joint of a URDF: the solver, another joint, the grasp, or nothing.
#pragma once

#include "engine/model/arm_model.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <urdf_model/model.h>

namespace fathom {

// What moves a joint: nothing, the solver, another joint or the grasp.
struct JointDrive {
    enum class Kind { Held, Free, Follows, Grasps } kind = Kind::Held;
    double value = 0.0;              // Held: [rad], [m]
    std::string why;                 // Held: for the user
    ArmMimic mimic;                  // Follows
    double open = 0.0, closed = 0.0; // Grasps
};

// One drive per joint that can move. chain: joints from base to tip. A group of mimic joints has one value:
// that of a locked member, else of its joint on the chain, else of a member that the options name as a
// finger. Throws BadInput for fingers and locked joints that do not fit.
std::map<std::string, JointDrive> driveJoints(const urdf::ModelInterface& model,
                                              const std::filesystem::path& file, const ArmOptions& options,
                                              std::span<const std::shared_ptr<const urdf::Joint>> chain);

// Whether the joint turns or slides about one axis.
bool hasAxis(const urdf::Joint& joint);

// The motion of a joint's child by `value` [rad], [m]; the joint has an axis.
Pose motionOf(const urdf::Joint& joint, double value);

} // namespace fathom
