// SPDX-License-Identifier: Apache-2.0
// The proxy of a tool on an arm: joint angles that follow the hand as closely as the joints allow, with no
// leaf of any link inside a region.
#pragma once

#include "engine/haptics/arm_kinematics.h"
#include "engine/haptics/constrained_proxy.h"

namespace fathom {

extern template class ConstrainedProxy<ArmKinematics>;

// The leaves of the whole arm at the given frames, as a tool whose frame is the base frame. The contact query
// uses it with an identity pose. Allocates, so call it at contact cadence. Throws Error beyond 4096 leaves.
Tool armTool(const ArmModel& arm, const ArmFrames& frames);

// Input of one tick. The contact set is that of armTool() at a recent posture.
struct ArmInput : ProxyInput {
    double grasp = 0.0; // 0 open .. 1 closed; not finite = keep the present grasp
};

// In addition to the guarantee of ConstrainedProxy, joints never leave [lower, upper] and never exceed their
// speed over a tick. Lines and axes constrain the tip, as far as the joints allow.
class ArmProxy : public ConstrainedProxy<ArmKinematics> {
public:
    // The start is clamped to the joint limits. `arm` must outlive this.
    ArmProxy(const ArmModel& arm, const Pose& baseTarm, const ArmProxyOptions& options,
             const JointVector& start, std::span<const Shape> shapes = {});

    ArmStep step(const ArmInput& input) noexcept;
    ArmStep step(const Pose& target, double metricRadius, const ContactSet* contacts) noexcept {
        return step({{target, metricRadius, contacts, {}}, posture().grasp});
    }

    // Sets the posture without a collision check, clamped to the joint limits. Joints whose value is not
    // finite keep their position. keep_in shapes hold the leaves that are inside there, and those that
    // they held and that are out by at most kOvershoot, as a real arm overshoots. The active set may no
    // longer be usable there: ask accepts().
    void setPosture(const ArmPosture& posture) noexcept {
        kinematics_.setPosture(posture);
        chooseHeld(kOvershoot);
    }

    static constexpr double kOvershoot = 0.02; // [m]

    const JointVector& joints() const { return posture().q; }
    const ArmPosture& posture() const { return kinematics_.posture(); }
    const ArmFrames& frames() const { return kinematics_.frames(); }
    Pose tip() const { return kinematics_.pose(); }
    size_t leafCount() const { return contacts_.leafCount(); }
    double leafRadius(size_t leaf) const { return contacts_.radius(leaf); }

private:
    void moveGrasp(double grasp, ArmStep& out) noexcept;

    bool hasFingers_;
    double graspPerTick_;
};

} // namespace fathom
