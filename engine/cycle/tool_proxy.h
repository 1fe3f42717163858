// SPDX-License-Identifier: Apache-2.0
// The tool of the haptic step: it moves freely, or it is the tip of an arm.
#pragma once

#include "engine/cycle/arm_setup.h"
#include "engine/cycle/step_record.h"

#include <optional>
#include <span>
#include <vector>

namespace fathom {

// Owns the proxy of the free tool or of the arm, and hides which of them there is. One thread. Allocates only
// in the constructor; the other functions are noexcept. Poses are base_T_tool.
class ToolProxy {
public:
    // start: pose of a free tool. arm: null = a free tool. Otherwise it must outlive this, and the tool is
    // the tip of its start posture.
    ToolProxy(const Tool& tool, std::span<const Shape> shapes, const ProxyOptions& options, const Pose& start,
              const ArmSetup* arm);

    // Moves the tool. buttons: StepInput::buttons, one of which may close the arm's gripper. An arm
    // overwrites `out`.
    ProxyStep step(const ProxyInput& wanted, uint32_t buttons, ArmRecord& out) noexcept;
    // A step in which the tool is not moved.
    void hold() noexcept { jointLimits_ = 0; }

    // Moves a free tool back to `pose` without any check. An arm stays where it is.
    void putBack(const Pose& pose, ProxyStep& moved) noexcept;
    // The hand map moved a free tool's target: the next step does not count that as motion of the hand.
    void setTarget(const Pose& target) noexcept;
    // Places the arm (onArm() must be true) without a check of the regions.
    void setPosture(const ArmPosture& posture) noexcept;
    // As ConstrainedProxy.
    void setShapes(std::span<const Shape> shapes) noexcept {
        arm_ ? arm_->setShapes(shapes) : proxy_->setShapes(shapes);
    }
    bool accepts(const ContactSet& set) noexcept { return arm_ ? arm_->accepts(set) : proxy_->accepts(set); }

    const Pose& pose() const noexcept { return pose_; }
    // Pose and, on an arm, posture.
    ToolPlace place() const noexcept { return {pose_, arm_ ? arm_->posture() : ArmPosture{}}; }
    bool onArm() const noexcept { return arm_.has_value(); }
    size_t jointCount() const noexcept { return arm_ ? setup_->model.count() : 0; } // 0 = free tool
    // The arm leaves the tool's direction free.
    bool freeDirection() const noexcept { return setup_ != nullptr && setup_->freeDirection; }
    uint32_t jointLimits() const noexcept { return jointLimits_; } // active position limits in the last step
    double leafRadius(uint32_t leaf) const noexcept {              // [m]
        return arm_ ? arm_->leafRadius(leaf) : leafRadius_[leaf];
    }

    // The tool's part of the record of a step: `moved` and its active rows; set: active, null = none.
    void record(const ContactSet* set, const ProxyStep& moved, StepRecord& out) const noexcept;

private:
    ProxyStep stepArm(const ProxyInput& wanted, uint32_t buttons, ArmRecord& out) noexcept;
    void recordTouches(const ContactSet* set, const ProxyStep& moved, StepRecord& out) const noexcept;
    std::span<const Shape> shapes() const noexcept { return arm_ ? arm_->shapes() : proxy_->shapes(); }

    const ArmSetup* setup_;
    std::optional<ArmProxy> arm_; // exactly one of these two exists
    std::optional<Proxy> proxy_;
    std::vector<double> leafRadius_; // [m] of a free tool
    Pose pose_;                      // after the last step
    uint32_t jointLimits_ = 0;
};

} // namespace fathom
