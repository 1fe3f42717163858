// SPDX-License-Identifier: Apache-2.0
// What names of links and joints say about an arm: tool frames and gripper joints.
#pragma once

#include <limits>
#include <string>
#include <urdf_model/joint.h>

namespace fathom {

inline constexpr size_t kNoTool = std::numeric_limits<size_t>::max(); // rank of other names

// Ends the name of the fixed joint that carries the site of an MJCF file.
inline constexpr const char* kSiteEnding = "__site";

// Rank of a tool frame's name, with or without a prefix such as "left_"; the best is 0. kNoTool = none.
size_t toolRank(const std::string& link);

// Whether a tool frame's name has a prefix before one of the words that parts of an arm have too:
// "wrist_flange", "forearm_hand", "calib_tool".
bool namesPart(const std::string& link);

// Whether the name says that the joint turns a hand, as that of a wrist, and does not close it.
bool turnsHand(const urdf::Joint& joint);

// Whether the names say that the joint closes a gripper.
bool closesGripper(const urdf::Joint& joint);

} // namespace fathom
