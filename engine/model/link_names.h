// SPDX-License-Identifier: Apache-2.0
// What names of links and joints say about an arm: tool frames and gripper joints.
#pragma once

#include <limits>
#include <string>
#include <urdf_model/model.h>
#include <vector>

namespace fathom {

inline constexpr size_t kNoTool = std::numeric_limits<size_t>::max(); // rank of other names

// Ends the name of the fixed joint that carries the site of an MJCF file.
inline constexpr const char* kSiteEnding = "__site";

// Rank of a tool frame's name, with or without a prefix such as "left_"; the best is 0. kNoTool = none.
size_t toolRank(const std::string& link);

// Whether it is a usual name of a tool's frame, from "tool0" to "flange", and not one of a hand or gripper.
bool namesTool(const std::string& link);

// Whether a tool frame's name has a prefix before one of the words that parts of an arm have too:
// "wrist_flange", "forearm_hand", "calib_tool".
bool namesPart(const std::string& link);

// Whether a part of the name is a hand or palm: "left_hand_base", "rightPalm".
bool namesHand(const std::string& link);

// Names the last link with a tool frame's or hand's name above the joint, for the message of a chain with too
// many joints: ", for example arm.tip: NAME". most: moving joints that the chain may have. Empty = none.
std::string tipAdvice(const urdf::ModelInterface& model, const urdf::Joint& joint, size_t most);

// The words of a joint's name and of its child link's, without those of a prefix that joints above it have,
// too: a robot called "pincher" has no gripper for that.
struct JointWords {
    std::vector<std::string> joint, link;
};
JointWords wordsOf(const urdf::ModelInterface& model, const urdf::Joint& joint);

// Whether the words say that the joint turns a hand, as that of a wrist, and does not close it.
bool turnsHand(const JointWords& words);

// Whether the words say that the joint closes a gripper. behind: moving joints on the longest way behind it,
// which are few in a gripper.
bool closesGripper(const JointWords& words, int behind);

} // namespace fathom
