// SPDX-License-Identifier: Apache-2.0
#include "engine/model/link_names.h"

#include "engine/model/gripper_joints.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <span>
#include <string_view>

namespace fathom {

namespace {

// Usual names of tool frames, the best first: ROS-Industrial's tool0 and flange, sites of MuJoCo's models,
// then frames of hands. New names go last, so that the robots of today keep their tips.
constexpr std::array kToolNames = std::to_array<std::string_view>({"tool0",
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
                                                                   "gripper_link",
                                                                   "endeffector_link",
                                                                   "pinch_site"});

// They count as "gripper_link", so that the frame wins if only that link has shapes.
constexpr std::array<std::string_view, 2> kGripperFrames{"gripper_frame_link", "gripperframe"};

// Also in names of links; the links "gripper" and "grasp_link" are often a wrist's.
constexpr std::array<std::string_view, 11> kGripperWords{
    "finger", "fngr", "jaw", "knuckle", "claw", "thumb", "pincer", "clamp", "pinch", "tong", "forceps"};
// A joint of this name moves a finger, also sideways: "thumb_yaw".
constexpr std::array<std::string_view, 4> kFingerWords{"finger", "fngr", "thumb", "knuckle"};
constexpr std::array<std::string_view, 1> kWrist{"wrist"};
constexpr std::array<std::string_view, 2> kHands{"hand", "palm"};
constexpr std::array<std::string_view, 4> kGripperJoints{"grip", "gripper", "grasp", "opening"};

// In the name of a joint these say that it turns a hand and does not close it.
constexpr std::array<std::string_view, 6> kWristWords{"wrist", "roll", "rotat", "pitch", "yaw", "swivel"};

// What words are joined to without a mark between: "lfinger", "fingertip", "wristrotation".
constexpr std::array<std::string_view, 8> kSides{"l",     "r",     "left",  "right",
                                                 "lower", "upper", "inner", "outer"};
constexpr std::array kEndings = std::to_array<std::string_view>(
    {"", "s", "e", "ion", "tip", "tips", "joint", "joints", "link", "motor", "proximal", "distal"});

constexpr int kBehindGripper = 2,
              kBehindFinger = 4; // moving joints behind the first of a gripper, of a finger
constexpr size_t kMaxAbove = 12; // joints above whose names are compared
constexpr size_t kSharers = 3;   // joints above that make a prefix of words

std::string lowered(std::string name) {
    name = name.substr(name.rfind('/') + 1);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::tolower(c)); });
    return name;
}

bool endsWith(const std::string& name, std::string_view word) {
    return name == word || (name.size() > word.size() + 1 && name.ends_with(word) &&
                            name[name.size() - word.size() - 1] == '_');
}

// The name of a link as the list of tool frames has it.
std::string toolName(const std::string& link) {
    std::string name = lowered(link);
    for (const std::string_view frame : kGripperFrames) {
        if (endsWith(name, frame)) {
            return name.replace(name.size() - frame.size(), frame.size(), "gripper_link");
        }
    }
    return name;
}

// Parts of a name between marks and digits, and before capitals; in small letters.
std::vector<std::string> namePartsOf(const std::string& name) {
    const auto isUpper = [](char c) { return c >= 'A' && c <= 'Z'; };
    const auto isLower = [](char c) { return c >= 'a' && c <= 'z'; };
    std::vector<std::string> parts(1);
    for (size_t i = name.rfind('/') + 1; i < name.size(); ++i) {
        const char c = name[i], before = i > 0 ? name[i - 1] : '_',
                   after = i + 1 < name.size() ? name[i + 1] : '_';
        const bool begins = isUpper(c) && (isLower(before) || (isUpper(before) && isLower(after)));
        const bool mark = !isUpper(c) && !isLower(c);
        if ((begins || mark) && !parts.back().empty()) {
            parts.emplace_back();
        }
        if (!mark) {
            parts.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
    }
    std::erase(parts, "");
    return parts;
}

// Whether the part begins or ends with the word, or has it behind a side: "fingertip", "eegripper".
bool holdsWord(const std::string& part, std::string_view word) {
    const size_t at = part.find(word);
    if (at == std::string::npos) {
        return false;
    }
    const std::string_view all(part), head = all.substr(0, at), tail = all.substr(at + word.size());
    return head.empty() || std::ranges::find(kSides, head) != kSides.end() ||
           std::ranges::find(kEndings, tail) != kEndings.end();
}

bool hasWord(const std::vector<std::string>& parts, std::span<const std::string_view> words) {
    return std::ranges::any_of(parts, [&](const std::string& part) {
        return std::ranges::any_of(words, [&](std::string_view word) { return holdsWord(part, word); });
    });
}

using MovingJoint = std::shared_ptr<const urdf::Joint>;

// Moving joints above the joint, the nearest first; at its root the nearest ones below it.
std::vector<MovingJoint> neighboursOf(const urdf::ModelInterface& model, const urdf::Joint& joint) {
    std::vector<MovingJoint> all;
    for (auto link = model.getLink(joint.parent_link_name); link && link->parent_joint;
         link = link->getParent()) {
        if (all.size() < kMaxAbove && moves(*link->parent_joint)) {
            all.push_back(link->parent_joint);
        }
    }
    std::vector<std::string> open;
    if (all.empty()) {
        open.push_back(joint.child_link_name);
    }
    while (!open.empty()) {
        const auto link = model.getLink(open.back());
        open.pop_back();
        for (const auto& below : link->child_joints) {
            moves(*below) ? all.push_back(below) : open.push_back(below->child_link_name);
        }
    }
    return all;
}

size_t sameParts(const std::vector<std::string>& a, const std::vector<std::string>& b) {
    return static_cast<size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

// The parts of a name behind those that enough of the others begin with, too.
std::vector<std::string> ownParts(const std::string& name, const std::vector<std::string>& others) {
    const std::vector<std::string> parts = namePartsOf(name);
    std::vector<size_t> shared;
    for (const std::string& other : others) {
        shared.push_back(sameParts(parts, namePartsOf(other)));
    }
    std::ranges::sort(shared, std::greater());
    size_t prefix = shared.empty() ? 0 : shared[std::min(kSharers, shared.size()) - 1];
    const auto tells = [](const std::string& part) { return part != "joint" && part != "link"; };
    if (prefix > 0 && prefix < parts.size() &&
        std::none_of(parts.begin() + static_cast<std::ptrdiff_t>(prefix), parts.end(), tells)) {
        --prefix; // "gripper_joint" behind "gripper_arm_wrist"
    }
    return {parts.begin() + static_cast<std::ptrdiff_t>(prefix), parts.end()};
}

} // namespace

size_t toolRank(const std::string& link) {
    const std::string name = toolName(link);
    size_t best = kNoTool;
    for (size_t i = 0; i < kToolNames.size(); ++i) {
        best = endsWith(name, kToolNames[i]) ? std::min(best, i) : best;
    }
    return best;
}

bool namesTool(const std::string& link) {
    const auto last = std::ranges::find(kToolNames, "flange");
    return toolRank(link) <= static_cast<size_t>(last - kToolNames.begin());
}

bool namesPart(const std::string& link) {
    const std::string name = toolName(link);
    const auto first = std::ranges::find(kToolNames, "flange");
    return toolRank(link) < kNoTool && std::ranges::find(kToolNames, name) == kToolNames.end() &&
           toolRank(link) >= static_cast<size_t>(first - kToolNames.begin());
}

bool namesHand(const std::string& link) {
    return std::ranges::any_of(namePartsOf(link), [](const std::string& part) {
        return std::ranges::any_of(kHands, [&](std::string_view word) {
            const std::string_view side = std::string_view(part).substr(0, part.size() - word.size());
            return part.ends_with(word) && (side.empty() || std::ranges::find(kSides, side) != kSides.end());
        });
    });
}

std::string tipAdvice(const urdf::ModelInterface& model, const urdf::Joint& joint, size_t most) {
    auto link = model.getLink(joint.parent_link_name);
    while (link && link->parent_joint && most > 0) {
        if (toolRank(link->name) < kNoTool || namesHand(link->name)) {
            return ", for example arm.tip: " + link->name;
        }
        most -= moves(*link->parent_joint) ? 1 : 0;
        link = link->getParent();
    }
    return "";
}

JointWords wordsOf(const urdf::ModelInterface& model, const urdf::Joint& joint) {
    std::vector<std::string> joints, links;
    for (const MovingJoint& other : neighboursOf(model, joint)) {
        joints.push_back(other->name);
        links.push_back(other->child_link_name);
    }
    return {ownParts(joint.name, joints), ownParts(joint.child_link_name, links)};
}

bool turnsHand(const JointWords& words) {
    return hasWord(words.joint, kWristWords) &&
           (hasWord(words.joint, kWrist) || !hasWord(words.joint, kFingerWords));
}

bool closesGripper(const JointWords& words, int behind) {
    const bool finger = hasWord(words.joint, kFingerWords) || hasWord(words.link, kFingerWords);
    return behind <= (finger ? kBehindFinger : kBehindGripper) && !turnsHand(words) &&
           (hasWord(words.joint, kGripperJoints) || hasWord(words.joint, kGripperWords) ||
            hasWord(words.link, kGripperWords));
}

} // namespace fathom
