// SPDX-License-Identifier: Apache-2.0
// What a URDF states about its joints for ros2_control and for Gazebo only.
#pragma once

#include <string>
#include <urdf_model/model.h>
#include <vector>

namespace fathom {

// Lets joints without <mimic> follow others as <ros2_control> or a mimic plugin of Gazebo states. Plugins of
// roboticsgroup name the leader <joint> and the follower <mimicJoint>, those of Care-O-bot the follower
// <jointName> and the leader <mimicJoint>; which is which is unknown for others. notes: gets a line for each
// joint that follows so, and for each statement that is not used.
void addControlMimics(urdf::ModelInterface& model, const std::string& text, std::vector<std::string>& notes);

// Adds a note for each joint whose position limits of <command_interface> are narrower than its <limit>.
void noteCommandLimits(const urdf::ModelInterface& model, const std::string& text,
                       std::vector<std::string>& notes);

} // namespace fathom
