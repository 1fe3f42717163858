// SPDX-License-Identifier: Apache-2.0
// A scene's arm, ready to run: model, start posture, options.
#pragma once

#include "engine/cloud/self_filter.h"
#include "engine/contact/tool.h"
#include "engine/haptics/arm_proxy.h"
#include "engine/scene/scene.h"

#include <memory>
#include <span>
#include <vector>

namespace fathom {

// Immutable after makeArmSetup(); any thread reads it.
struct ArmSetup {
    ArmModel model; // the scene's tool is its last link, "tool", fixed to the tip
    Pose baseTarm;
    JointVector start{};   // [rad], [m] within the limits
    ArmProxyOptions proxy; // step cap, solves and period come from the scene
    bool freeDirection = false;
    uint32_t graspButton = 0; // 0 = none
    double padding = 0.0;     // [m] of the self-filter: the scene's value plus 3 sigma of the registration

    ArmPosture startPosture() const noexcept { return {start, 0.0}; }
    ArmFrames framesAt(const ArmPosture& posture) const noexcept;
    Pose tipAt(const ArmPosture& posture) const noexcept { return model.tip(framesAt(posture)); }
    // All leaves of all links in the base frame: the tool for a contact query with an identity pose.
    // Allocates.
    Tool toolAt(const ArmPosture& posture) const { return armTool(model, framesAt(posture)); }
    // The same spheres relative to the tip, for displays. Allocates.
    std::vector<Sphere> aboutTip(const ArmPosture& posture) const;
    // The same spheres in the base frame, grown by the padding, for the self-filter. Allocates.
    cloud::ArmSpheres inImage(const ArmPosture& posture) const;
    // The leaves that the last joint and the fingers carry at the start, relative to the tip. The springs'
    // lever and the built-in path use this tool. All leaves if there are none.
    Tool heldTool() const;
};

// Null without `arm:`. toolLeaves: leaves of the scene's tool in the tip's frame; may be empty. Throws
// BadInput that names the scene's field for joints and links that the URDF lacks, a tip that no joint
// moves, a start outside the limits, or more than 4096 leaves.
std::unique_ptr<ArmSetup> makeArmSetup(const Scene& scene, std::span<const Sphere> toolLeaves,
                                       const ReaderOptions& reader = {});

} // namespace fathom
