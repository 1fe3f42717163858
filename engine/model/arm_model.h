// SPDX-License-Identifier: Apache-2.0
// An arm from URDF: the chain of moving joints from the base to a tip, and the spheres of every link that it
// carries.
#pragma once

#include "engine/types/sphere_tree.h"

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fathom {

inline constexpr size_t kMostJoints = 7;  // the solver takes eight unknowns
inline constexpr size_t kMostFingers = 4; // joints of the jaws, of one arm

// A moving joint of the chain, or a finger's.
struct ArmJoint {
    std::string name;
    bool slides = false;       // prismatic; else it turns
    Pose before;               // link before it -> joint frame at q = 0
    dvec3 axis{0.0, 0.0, 1.0}; // unit, joint frame
    double lower, upper;       // [rad], [m]; +-inf for continuous joints
    double speed;              // [rad/s], [m/s] > 0
};

// A joint beside the chain that the grasp moves: from `open` at grasp 0 to `closed` at grasp 1.
struct ArmFinger {
    std::string name;
    uint32_t joint = 0; // how many joints of the chain carry it
    bool slides = false;
    Pose before;                     // frame after `joint` joints -> finger's frame at 0
    dvec3 axis{0.0, 0.0, 1.0};       // unit, finger's frame
    double open = 0.0, closed = 0.0; // [rad], [m]
    double lower = -std::numeric_limits<double>::infinity(); // [rad], [m] of the URDF
    double upper = std::numeric_limits<double>::infinity();
};

// A sphere of a link.
struct ArmLeaf {
    Sphere sphere;       // in its frame [m]: of `finger`, or the one after `joint` moving joints
    uint32_t joint;      // how many joints move it: 0 = stands still
    uint32_t link;       // of ArmModel::links
    uint32_t finger = 0; // 0 = none; else fingers[finger - 1] moves it too
};

using JointVector = std::array<double, kMostJoints>; // [rad], [m]; what is beyond the joints is 0

// All that says where an arm's leaves are.
struct ArmPosture {
    JointVector q{};
    double grasp = 0.0; // 0 open .. 1 closed
};

// Where the moving frames are: frames[0] is the base, frames[k] the one after k joints, frames[kMostJoints +
// 1 + f] that of finger f.
using ArmFrames = std::array<Pose, kMostJoints + 1 + kMostFingers>;

// Immutable after loading; its functions are noexcept and do not allocate.
class ArmModel {
public:
    std::vector<ArmJoint> joints;   // base to tip
    std::vector<ArmFinger> fingers; // those that ArmOptions names
    std::vector<ArmLeaf> leaves;    // by link; other joints off the chain stand at 0
    std::vector<std::string> links; // that have leaves
    Pose lastTtip;                  // frame after the last joint -> tip
    std::vector<std::string> notes; // a line each: what the files have and the leaves have not

    size_t count() const { return joints.size(); }
    // Frames of joints and fingers at joint values q [rad], [m], grasp 0 open .. 1 closed.
    void place(const JointVector& q, const Pose& worldTbase, ArmFrames& frames,
               double grasp = 0.0) const noexcept;
    Pose tip(const ArmFrames& frames) const noexcept { return frames[count()] * lastTtip; }
    size_t frameOf(size_t leaf) const noexcept { // of ArmFrames
        return leaves[leaf].finger == 0 ? leaves[leaf].joint : kMostJoints + leaves[leaf].finger;
    }
    dvec3 centre(const ArmFrames& frames, size_t leaf) const noexcept {
        return frames[frameOf(leaf)].apply(leaves[leaf].sphere.centre);
    }
    // How joint `k` moves a point that is carried by it: d point / d q_k [m/rad], [1]. axis: its direction.
    dvec3 motionOf(const ArmFrames& frames, size_t k, const dvec3& point) const noexcept;
    dvec3 axisOf(const ArmFrames& frames, size_t k) const noexcept {
        return frames[k + 1].rotation * joints[k].axis;
    }
};

// What of the URDF the arm is, where a scene says otherwise than the file.
struct ArmOptions {
    // A joint that opens and closes and is not of the chain.
    struct Finger {
        std::string joint;
        std::optional<double> open, closed; // [rad], [m]; empty = the lower and the upper limit of the URDF
    };
    std::vector<Finger>
        fingers;           // joints beside the chain, on links that only the chain and fixed joints carry
    std::string base, tip; // links; empty = the root, and the end of the longest chain of moving joints
    std::filesystem::path meshes; // what package:// stands for; empty = the URDF's folder and those above
    uint32_t leavesPerShape = 24; // of collision boxes, cylinders and meshes; spheres are taken as they are
};

// Throws BadInput: no such link or finger, more than kMostJoints moving joints, planar or floating joints,
// limits that are missing or crossed, a mesh that cannot be used.
ArmModel loadArm(const std::filesystem::path& urdf, const ArmOptions& options = {});

} // namespace fathom
