// SPDX-License-Identifier: Apache-2.0
// Which joints of a URDF close a gripper or are those of a hand.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <urdf_model/model.h>
#include <vector>

namespace fathom {

// Whether the joint is planar or floating.
bool isFree(const urdf::Joint& joint);
// Whether the joint counts in a chain, which cannot contain free joints.
bool moves(const urdf::Joint& joint);

// The model must outlive this. One thread.
class GripperJoints {
public:
    // file: for messages. Throws BadInput as tieJoints().
    GripperJoints(const urdf::ModelInterface& model, const std::filesystem::path& file);

    // Moving joints on the longest way below the link; the same with the joint itself.
    int depthBelow(const std::string& link) const { return depths_.at(link); }
    int depthThrough(const urdf::Joint& joint) const;
    // Branches below the link with moving joints.
    size_t branches(const urdf::Link& link) const;

    // Whether branches of moving joints at the link are fingers: alike, but for one thumb or motor; of a
    // link named as a hand, half of them. moving: joints between base and link.
    bool branchesIntoFingers(const urdf::Link& link, int moving) const;
    // Whether the joint closes a gripper, by what it is tied to, by the fingers that it moves, or as a jaw.
    // moving: joints above it; last: the nearest of them.
    bool closes(const urdf::Joint& joint, int moving, const urdf::Joint* last) const;
    // The same by its names.
    bool closesByName(const urdf::Joint& joint) const;

private:
    int measure(const urdf::Link& link);
    int measureDriven(const urdf::Link& link, bool onFinger);
    std::span<const urdf::Joint* const> groupOf(const urdf::Joint& joint) const;
    bool tiedToChain(const urdf::Joint& joint) const;
    bool movesFingers(const urdf::Joint& joint) const;
    std::vector<int> tiedBelow(const urdf::Link& link, const std::string& root) const;
    int depthBeside(const urdf::Link& link, const std::string& root) const;
    bool isAbove(const urdf::Joint& upper, const urdf::Joint& lower) const;

    const urdf::ModelInterface& model_;
    std::map<std::string, int> depths_;                             // moving joints below each link
    std::map<std::string, int> driven_;                             // the same by measureDriven()
    std::map<std::string, std::string> roots_;                      // of moving joints, see JointTie
    std::map<std::string, std::vector<const urdf::Joint*>> groups_; // by root
};

} // namespace fathom
