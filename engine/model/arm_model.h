// SPDX-License-Identifier: Apache-2.0
// An arm from a URDF: the chain of moving joints from base to tip, and the spheres that cover its links.
#pragma once

#include "engine/model/reader_process.h"
#include "engine/types/sphere_tree.h"

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

inline constexpr size_t kMaxJoints = 12;     // moving joints of a chain, mimic joints included
inline constexpr size_t kMaxFingers = 16;    // moving joints off the chain
inline constexpr double kUnknownTurn = 1.0;  // [rad/s] speed of a revolute joint whose URDF states none
inline constexpr double kUnknownSlide = 0.1; // [m/s] the same for a prismatic joint
inline constexpr const char* kDefaultSpeedSource =
    "default, the file states none"; // their source, for messages

// A joint at offset + multiplier * (another joint).
struct ArmMimic {
    uint32_t joint = 0; // of the chain, follows no other
    double multiplier = 1.0, offset = 0.0;
};

// A moving joint of the chain.
struct ArmJoint {
    std::string name;
    bool slides = false;       // prismatic; else revolute
    Pose before;               // link before it -> joint frame at q = 0
    dvec3 axis{0.0, 0.0, 1.0}; // unit, joint frame
    double lower, upper;       // [rad], [m]; +-inf for continuous joints
    double speed;              // [rad/s], [m/s] > 0
    std::optional<ArmMimic> mimic{};
    std::string limitsFrom = "file", speedFrom = "file"; // for the user
};

// A moving joint off the chain. A gripper joint is at `open` when grasp is 0 and at `closed` when grasp is 1;
// others follow a joint of the chain.
struct ArmFinger {
    std::string name;
    uint32_t joint = 0; // number of chain joints between it and the base
    bool slides = false;
    Pose before;                     // frame after `joint` joints -> finger's frame at 0
    dvec3 axis{0.0, 0.0, 1.0};       // unit, finger's frame
    double open = 0.0, closed = 0.0; // [rad], [m]
    double lower = -std::numeric_limits<double>::infinity(); // [rad], [m] of the URDF
    double upper = std::numeric_limits<double>::infinity();
    uint32_t carrier = 0;            // 0 = none; else fingers[carrier - 1], an earlier one, carries it
    std::optional<ArmMimic> mimic{}; // follows this joint of the chain instead of the grasp
    double speed = std::numeric_limits<double>::infinity(); // [rad/s], [m/s] of the URDF
};

// A sphere of a link.
struct ArmLeaf {
    Sphere sphere;       // [m] in the frame of `finger`, or in the frame after `joint` moving joints
    uint32_t joint;      // number of joints that move it; 0 = fixed to the base
    uint32_t link;       // index into ArmModel::links
    uint32_t finger = 0; // 0 = none; else fingers[finger - 1] moves it too
};

using JointVector = std::array<double, kMaxJoints>; // [rad] or [m]; unused entries are 0

// The state that places every leaf of an arm.
struct ArmPosture {
    JointVector q{};
    double grasp = 0.0; // 0 open .. 1 closed
};

// Poses of the moving frames: frames[0] is the base, frames[k] the frame after k joints, and
// frames[kMaxJoints + 1 + f] the frame of finger f.
using ArmFrames = std::array<Pose, kMaxJoints + 1 + kMaxFingers>;

// Immutable after loading; its functions are noexcept and do not allocate.
class ArmModel {
public:
    std::vector<ArmJoint> joints; // base to tip
    std::vector<ArmFinger>
        fingers;                 // that move: named by ArmOptions, or mimic joints of those or of the chain
    std::vector<ArmLeaf> leaves; // grouped by link
    std::vector<std::string> links; // that have leaves
    Pose lastTtip;                  // frame after the last joint -> tip
    std::vector<std::string> notes; // one warning per line: what no leaf covers, defaults
    std::string baseText, tipText;  // links, each with the reason for its choice
    std::vector<std::string> held;  // one line per joint that stays where it is

    size_t count() const { return joints.size(); }
    // Sets the mimic joints from the ones that they follow.
    void follow(JointVector& q) const noexcept;
    // Frames of joints and fingers at joint values q [rad], [m], grasp 0 open .. 1 closed.
    void place(const JointVector& q, const Pose& worldTbase, ArmFrames& frames,
               double grasp = 0.0) const noexcept;
    Pose tip(const ArmFrames& frames) const noexcept { return frames[count()] * lastTtip; }
    size_t frameOf(size_t leaf) const noexcept { // of ArmFrames
        return leaves[leaf].finger == 0 ? leaves[leaf].joint : kMaxJoints + leaves[leaf].finger;
    }
    dvec3 centre(const ArmFrames& frames, size_t leaf) const noexcept {
        return frames[frameOf(leaf)].apply(leaves[leaf].sphere.centre);
    }
    // Some finger, or joint with a range, displaces the leaf's centre: it is not only turned about itself.
    bool moves(size_t leaf) const noexcept;
    // Velocity of a point carried by joint `k`: d point / d q_k [m/rad] or [1]. axis: direction of the joint.
    // Mimic joints that follow k are not included.
    dvec3 motionOf(const ArmFrames& frames, size_t k, const dvec3& point) const noexcept;
    dvec3 motionOfFinger(const ArmFrames& frames, size_t f, const dvec3& point) const noexcept;
    dvec3 axisOf(const ArmFrames& frames, size_t k) const noexcept {
        return frames[k + 1].rotation * joints[k].axis;
    }
    // Angular velocity of the tip per speed of joint `k`: the axis, or zero for a sliding joint.
    dvec3 rotationOf(const ArmFrames& frames, size_t k) const noexcept {
        return joints[k].slides ? dvec3(0.0) : axisOf(frames, k);
    }
};

// Which part of the URDF is the arm, and what the scene overrides.
struct ArmOptions {
    // A gripper joint, which is not part of the chain.
    struct Finger {
        std::string joint;
        // [rad], [m]; empty = a limit of the URDF: see chooseFingerEnds(). If the shapes do not decide, the
        // one farther from 0 is open if it slides, else the lower one.
        std::optional<double> open, closed;
    };
    std::vector<Finger> fingers;          // joints off the chain; one per group of mimic joints is enough
    std::string base, tip;                // links; empty = chosen by the tree, see chooseEnds()
    std::map<std::string, double> locked; // joints that stay at this value [rad], [m], on or off the chain
    std::filesystem::path meshes; // root of package:// paths; empty = the URDF's folder and its parents
    uint32_t leavesPerShape = 24; // for each collision box, cylinder and mesh; spheres are used as they are
    bool keepStray = false;       // keep the pieces of a mesh that lie far from the rest
    ReaderOptions reader;         // of the processes that read the files
};

// Throws BadInput for an unknown link, finger or locked joint, more than kMaxJoints moving joints, planar or
// floating joints on the chain, missing or crossed limits, mimic joints without a master, or an unusable
// mesh.
ArmModel loadArm(const std::filesystem::path& urdf, const ArmOptions& options = {});

} // namespace fathom
