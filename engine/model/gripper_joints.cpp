// SPDX-License-Identifier: Apache-2.0
#include "engine/model/gripper_joints.h"

#include "engine/model/arm_mimic.h"
#include "engine/model/jaw_joint.h"
#include "engine/model/link_names.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr int kFingerDepth = 4; // joints of a finger
constexpr int kHandDepth = 5;   // of a finger among three and more
constexpr size_t kFewFingers = 3;
constexpr int kNamedDepth = 8; // of a finger on a link named as a hand, also with joints of simulators
constexpr int kOwnWrist = 2;   // joints of a forearm that belongs to a hand
constexpr int kArmRest = 3;    // joints of an arm behind one whose balancers or rods are tied to it

// Whether the depths, in rising order, differ by at most one joint.
bool areAlike(std::span<const int> depths) {
    return depths.size() > 1 && depths.back() - depths.front() <= 1;
}

// The most of the depths, in rising order, that are alike.
size_t mostAlike(std::span<const int> depths) {
    size_t most = 0, first = 0;
    for (size_t i = 0; i < depths.size(); ++i) {
        while (depths[i] - depths[first] > 1) {
            ++first;
        }
        most = std::max(most, i + 1 - first);
    }
    return most;
}

} // namespace

bool isFree(const urdf::Joint& joint) {
    return joint.type == urdf::Joint::FLOATING || joint.type == urdf::Joint::PLANAR;
}

bool moves(const urdf::Joint& joint) {
    return joint.type != urdf::Joint::FIXED && !isFree(joint);
}

GripperJoints::GripperJoints(const urdf::ModelInterface& model, const std::filesystem::path& file)
    : model_(model) {
    measure(*model.getRoot());
    for (const auto& [name, tie] : tieJoints(model, file)) {
        const urdf::Joint& joint = *model.joints_.at(name);
        if (moves(joint) && moves(*model.joints_.at(tie.root))) {
            roots_[name] = tie.root;
            groups_[tie.root].push_back(&joint);
        }
    }
    measureDriven(*model.getRoot(), false);
}

int GripperJoints::measure(const urdf::Link& link) {
    int most = 0;
    for (const auto& joint : link.child_joints) {
        most = std::max(most, measure(*model_.getLink(joint->child_link_name)) + moves(*joint));
    }
    return depths_[link.name] = most;
}

// Moving joints on the longest way below the link, without the passive ones of fingers: joints without limits
// behind a tied one, as in the pads of simulated grippers.
int GripperJoints::measureDriven(const urdf::Link& link, bool onFinger) {
    int most = 0;
    for (const auto& joint : link.child_joints) {
        const bool tied = groupOf(*joint).size() > 1;
        const bool passive = onFinger && !tied && joint->type == urdf::Joint::CONTINUOUS;
        const int below = measureDriven(*model_.getLink(joint->child_link_name), onFinger || tied);
        most = std::max(most, below + (moves(*joint) && !passive));
    }
    return driven_[link.name] = most;
}

int GripperJoints::depthThrough(const urdf::Joint& joint) const {
    return depths_.at(joint.child_link_name) + moves(joint);
}

size_t GripperJoints::branches(const urdf::Link& link) const {
    return static_cast<size_t>(std::count_if(link.child_joints.begin(), link.child_joints.end(),
                                             [&](const auto& joint) { return depthThrough(*joint) > 0; }));
}

bool GripperJoints::branchesIntoFingers(const urdf::Link& link, int moving) const {
    std::vector<int> depths;
    bool tied = toolRank(link.name) < kNoTool; // or named as a hand
    for (const auto& joint : link.child_joints) {
        if (const int depth = depthThrough(*joint); depth > 0) {
            depths.push_back(depth);
            tied = tied || (moves(*joint) && groupOf(*joint).size() > 1 && !tiedToChain(*joint));
        }
    }
    std::sort(depths.begin(), depths.end());
    const size_t n = depths.size();
    // A hand by its name may have several motors and a thumb beside its fingers.
    if (n > kFewFingers && namesHand(link.name) && moving > kOwnWrist && depths.back() <= kNamedDepth &&
        2 * mostAlike(depths) >= n) {
        return true;
    }
    if (n < 2 || depths.back() > (n < kFewFingers ? kFingerDepth : kHandDepth) || moving < 2 ||
        moving < depths.back()) {
        return false;
    }
    // One of them may be a thumb or a motor: of three branches, as of a trunk with two arms and a head, only
    // where something else says that it is a hand.
    const bool odd = n > kFewFingers || (n == kFewFingers && tied);
    const std::span<const int> all(depths);
    return areAlike(all) || (odd && (areAlike(all.first(n - 1)) || areAlike(all.last(n - 1))));
}

bool GripperJoints::closes(const urdf::Joint& joint, int moving, const urdf::Joint* last) const {
    if (!moves(joint) || moving < 2) {
        return false;
    }
    const bool tiedEnd = groupOf(joint).size() > 1 && depthThrough(joint) <= 2 && !tiedToChain(joint);
    const bool jaw = depthThrough(joint) == 1 && slidesLikeJaw(model_, joint, last);
    return tiedEnd || movesFingers(joint) || (jaw && !turnsHand(wordsOf(model_, joint)));
}

bool GripperJoints::closesByName(const urdf::Joint& joint) const {
    return moves(joint) && closesGripper(wordsOf(model_, joint), driven_.at(joint.child_link_name));
}

// The joint and those that are tied to it; empty if it follows one that cannot move.
std::span<const urdf::Joint* const> GripperJoints::groupOf(const urdf::Joint& joint) const {
    const auto root = roots_.find(joint.name);
    return root == roots_.end() ? std::span<const urdf::Joint* const>{} : groups_.at(root->second);
}

// Whether the joint mimics one above it or is mimicked from below, as in a chain with coupled joints, or
// no joint of its group is on another branch, as in a gripper.
bool GripperJoints::tiedToChain(const urdf::Joint& joint) const {
    const auto group = groupOf(joint);
    const bool coupled = std::any_of(group.begin(), group.end(), [&](const urdf::Joint* other) {
        return joint.mimic ? other->name == joint.mimic->joint_name && isAbove(*other, joint)
                           : other->mimic && other->mimic->joint_name == joint.name && isAbove(joint, *other);
    });
    const auto alongAll = [&](const urdf::Joint* one) {
        return std::all_of(group.begin(), group.end(), [&](const urdf::Joint* other) {
            return one == other || isAbove(*one, *other) || isAbove(*other, *one);
        });
    };
    return coupled || std::all_of(group.begin(), group.end(), alongAll);
}

// Whether two or more branches below it have joints that are tied to it, whatever hangs on those. An arm may
// continue next to its balancers, or behind one of them.
bool GripperJoints::movesFingers(const urdf::Joint& joint) const {
    if (groupOf(joint).size() < 3) {
        return false;
    }
    const urdf::Link& link = *model_.getLink(joint.child_link_name);
    const std::string& root = roots_.at(joint.name);
    std::vector<int> depths = tiedBelow(link, root);
    std::sort(depths.rbegin(), depths.rend());
    return depths.size() > 1 && depths[0] - depths[1] < kArmRest && depthBeside(link, root) < kArmRest;
}

// For each branch below the link that has joints of the root's group: its depth from the first of them, or
// from where they part, without passive joints.
std::vector<int> GripperJoints::tiedBelow(const urdf::Link& link, const std::string& root) const {
    std::vector<int> all;
    for (const auto& joint : link.child_joints) {
        std::vector<int> below = tiedBelow(*model_.getLink(joint->child_link_name), root);
        const auto tied = roots_.find(joint->name);
        if (below.size() < 2 && tied != roots_.end() && tied->second == root) {
            below = {driven_.at(joint->child_link_name) + 1};
        }
        all.insert(all.end(), below.begin(), below.end());
    }
    return all;
}

// Moving joints on the longest way below the link that begins with none of the root's group.
int GripperJoints::depthBeside(const urdf::Link& link, const std::string& root) const {
    int most = 0;
    for (const auto& joint : link.child_joints) {
        const auto tied = roots_.find(joint->name);
        if (!moves(*joint)) {
            most = std::max(most, depthBeside(*model_.getLink(joint->child_link_name), root));
        } else if (tied == roots_.end() || tied->second != root) {
            most = std::max(most, depthThrough(*joint));
        }
    }
    return most;
}

bool GripperJoints::isAbove(const urdf::Joint& upper, const urdf::Joint& lower) const {
    for (auto link = model_.getLink(lower.parent_link_name); link; link = link->getParent()) {
        if (link->name == upper.child_link_name) {
            return true;
        }
    }
    return false;
}

} // namespace fathom
