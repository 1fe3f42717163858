// SPDX-License-Identifier: Apache-2.0
// The arm of a scene, looked up and ready to run: model, start, options. A scene without an arm has none.
#pragma once

#include "engine/cloud/self_filter.h"
#include "engine/contact/tool.h"
#include "engine/haptics/arm_proxy.h"
#include "engine/scene/scene.h"

#include <memory>
#include <span>
#include <vector>

namespace fathom {

// Immutable after makeArmRig(); any thread reads it.
struct ArmRig {
    ArmModel model; // the scene's tool is its last link, "tool", fixed to the tip
    Pose baseTarm;
    JointVector start{};   // inside the limits
    ArmProxyOptions proxy; // step cap, solves and period are the scene's
    bool freeDirection = false;
    uint32_t graspButton = 0; // 0 = none
    double padding = 0.0;     // [m] of the self-filter: what the scene says and 3 sigma of the registration

    ArmPosture startPosture() const noexcept { return {start, 0.0}; }
    ArmFrames framesAt(const ArmPosture& posture) const noexcept;
    Pose tipAt(const ArmPosture& posture) const noexcept { return model.tip(framesAt(posture)); }
    // All leaves of all links, in the base frame: what a contact query asks about, with an identity pose.
    // Allocates.
    Tool toolAt(const ArmPosture& posture) const { return armTool(model, framesAt(posture)); }
    // The same spheres about the tip, for frames. Allocates.
    std::vector<Sphere> aboutTip(const ArmPosture& posture) const;
    // The same spheres in the base frame, grown by the padding: what the self-filter takes out. Allocates.
    cloud::LinkSpheres inImage(const ArmPosture& posture) const;
    // What the last joint and the fingers carry at the start, about the tip: the hand's tool, that the
    // springs' lever and the built-in path go by. All leaves where nothing hangs there.
    Tool heldTool() const;
};

// Null without `arm:`. toolLeaves: of the scene's tool, in the tip's frame; may be empty. Throws BadInput
// that names the scene's field: joints and links that the URDF does not have, starts outside the limits, more
// than 4096 leaves.
std::unique_ptr<ArmRig> makeArmRig(const Scene& scene, std::span<const Sphere> toolLeaves);

} // namespace fathom
