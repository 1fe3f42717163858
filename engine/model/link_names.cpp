// SPDX-License-Identifier: Apache-2.0
#include "engine/model/link_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string_view>

namespace fathom {

namespace {

// Usual names of tool frames, the best first: ROS-Industrial's tool0 and flange, sites of MuJoCo's models,
// then frames of hands.
constexpr std::array<std::string_view, 27> kToolNames{"tool0",
                                                      "tcp",
                                                      "tool_frame",
                                                      "tool_tip",
                                                      "tool_link",
                                                      "ee_link",
                                                      "end_effector_link",
                                                      "ee",
                                                      "eef",
                                                      "end_effector",
                                                      "link_eef",
                                                      "link_ee",
                                                      "grasping_frame",
                                                      "grasp_frame",
                                                      "attachment_site",
                                                      "tcp_site",
                                                      "ee_site",
                                                      "eef_site",
                                                      "pinch",
                                                      "flange",
                                                      "tool",
                                                      "hand",
                                                      "hand_link",
                                                      "palm_link",
                                                      "gripper_base_link",
                                                      "gripper_base",
                                                      "gripper_link"};

// Also in names of links; the links "gripper" and "grasp_link" are often a wrist's.
constexpr std::array<std::string_view, 11> kGripperWords{
    "finger", "fngr", "jaw", "knuckle", "claw", "thumb", "pincer", "clamp", "pinch", "tong", "forceps"};
// A joint of this name moves a finger, also sideways: "thumb_yaw".
constexpr std::array<std::string_view, 3> kFingerWords{"finger", "fngr", "thumb"};
constexpr std::string_view kWrist = "wrist";
constexpr std::array<std::string_view, 3> kGripperJoints{"grip", "grasp", "opening"};

// In the name of a joint these say that it turns a hand and does not close it.
constexpr std::array<std::string_view, 6> kWristWords{"wrist", "roll", "rotat", "pitch", "yaw", "swivel"};

std::string lowered(std::string name) {
    name = name.substr(name.rfind('/') + 1);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::tolower(c)); });
    return name;
}

bool hasWord(const std::string& name, std::span<const std::string_view> words) {
    const std::string low = lowered(name);
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return low.find(word) != std::string::npos; });
}

} // namespace

size_t toolRank(const std::string& link) {
    const std::string name = lowered(link);
    size_t best = kNoTool;
    for (size_t i = 0; i < kToolNames.size(); ++i) {
        const std::string_view word = kToolNames[i];
        const bool ends = name.size() > word.size() + 1 && name.ends_with(word) &&
                          name[name.size() - word.size() - 1] == '_';
        best = name == word || ends ? std::min(best, i) : best;
    }
    return best;
}

bool namesPart(const std::string& link) {
    const std::string name = lowered(link);
    const auto first = std::find(kToolNames.begin(), kToolNames.end(), "flange");
    return toolRank(link) < kNoTool &&
           std::find(kToolNames.begin(), kToolNames.end(), name) == kToolNames.end() &&
           toolRank(link) >= static_cast<size_t>(first - kToolNames.begin());
}

bool turnsHand(const urdf::Joint& joint) {
    const bool wrist = lowered(joint.name).find(kWrist) != std::string::npos;
    return hasWord(joint.name, kWristWords) && (wrist || !hasWord(joint.name, kFingerWords));
}

bool closesGripper(const urdf::Joint& joint) {
    return !turnsHand(joint) && (hasWord(joint.name, kGripperJoints) || hasWord(joint.name, kGripperWords) ||
                                 hasWord(joint.child_link_name, kGripperWords));
}

} // namespace fathom
