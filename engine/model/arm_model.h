// SPDX-License-Identifier: Apache-2.0
// An arm from URDF: the chain of moving joints from the base to a tip, and the spheres of every link that it
// carries.
#pragma once

#include "engine/types/sphere_tree.h"

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fathom {

inline constexpr size_t kMostJoints = 7; // the solver takes eight unknowns

struct ArmJoint {
    std::string name;
    bool slides = false;       // prismatic; else it turns
    Pose before;               // link before it -> joint frame at q = 0
    dvec3 axis{0.0, 0.0, 1.0}; // unit, joint frame
    double lower, upper;       // [rad], [m]; +-inf for continuous joints
    double speed;              // [rad/s], [m/s] > 0
};

struct ArmLeaf {
    Sphere sphere;  // in the frame after `joint` moving joints [m]
    uint32_t joint; // how many joints move it: 0 = stands still
    uint32_t link;  // of ArmModel::links
};

using JointVector = std::array<double, kMostJoints>; // [rad], [m]; what is beyond the joints is 0

// Where the moving frames are: frames[0] is the base, frames[k] the one after k joints.
using ArmFrames = std::array<Pose, kMostJoints + 1>;

// Immutable after loading; its functions are noexcept and do not allocate.
class ArmModel {
public:
    std::vector<ArmJoint> joints; // base to tip
    std::vector<ArmLeaf> leaves;  // by link; joints off the chain (fingers) stand at 0 or their nearest limit
    std::vector<std::string> links; // that have leaves
    Pose lastTtip;                  // frame after the last joint -> tip

    size_t count() const { return joints.size(); }
    void place(const JointVector& q, const Pose& worldTbase, ArmFrames& frames) const noexcept;
    Pose tip(const ArmFrames& frames) const noexcept { return frames[count()] * lastTtip; }
    dvec3 centre(const ArmFrames& frames, size_t leaf) const noexcept {
        return frames[leaves[leaf].joint].apply(leaves[leaf].sphere.centre);
    }
    // How joint `k` moves a point that is carried by it: d point / d q_k [m/rad], [1]. axis: its direction.
    dvec3 motionOf(const ArmFrames& frames, size_t k, const dvec3& point) const noexcept;
    dvec3 axisOf(const ArmFrames& frames, size_t k) const noexcept {
        return frames[k + 1].rotation * joints[k].axis;
    }
};

struct ArmOptions {
    std::string base, tip; // links; empty = the root, and the end of the longest chain of moving joints
    std::filesystem::path meshes; // what package:// stands for; empty = the URDF's folder and those above
    uint32_t leavesPerShape = 24; // of collision boxes, cylinders and meshes; spheres are taken as they are
};

// Throws BadInput: no such link, more than kMostJoints moving joints, planar or floating joints, limits that
// are missing or crossed, a mesh that cannot be used.
ArmModel loadArm(const std::filesystem::path& urdf, const ArmOptions& options = {});

} // namespace fathom
