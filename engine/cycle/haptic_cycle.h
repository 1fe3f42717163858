// SPDX-License-Identifier: Apache-2.0
// One step of the haptic cadence: from the hand's pose to the wrench, in the same tick.
#pragma once

#include "engine/cycle/active_regions.h"
#include "engine/cycle/arm_hold.h"
#include "engine/cycle/device_losses.h"
#include "engine/cycle/mapped_hand.h"
#include "engine/cycle/pressed_regions.h"
#include "engine/cycle/query_ahead.h"
#include "engine/cycle/tool_proxy.h"
#include "engine/cycle/wrench_stage.h"
#include "engine/haptics/stiffness_watch.h"

#include <algorithm>
#include <span>

namespace fathom {

// Haptic thread only. The constructor allocates and throws Error; the other functions are noexcept, and
// step() never allocates, locks, waits or uses Vulkan. SI units; poses are base_T_tool. The caller owns the
// device, the clock and the contact sets.
//
// Placed shapes and the active contact set hold the tool, and their active rows push the hand. Faults are
// values of the record: StepRecord::state tells why there is no force, and `finite` is false in a step with a
// number that is not finite, whose wrench is zero. The rules of a step are in docs/architecture/tick.md.
class HapticCycle {
public:
    // start: raw pose of the hand before the first step. The tool starts where the hand commands it or, if
    // given, at base_T_tool `tool0`, with the hand map aligned as after a clutch. arm: null = the tool moves
    // freely. Otherwise it must outlive this, the tool is its tip and starts there (tool0, if given, only
    // requests the alignment), and contact sets refer to ArmSetup::toolAt().
    HapticCycle(const Tool& tool, std::span<const Shape> shapes, const HapticOptions& options,
                const Pose& start, const Pose* tool0 = nullptr, const ArmSetup* arm = nullptr);

    HapticCycle(const HapticCycle&) = delete;
    HapticCycle& operator=(const HapticCycle&) = delete;

    StepRecord step(const StepInput& input) noexcept;

    // Call before a step when a real arm follows; the first call connects it. While the arm stands still, or
    // must, the tool is held and the force ramps out. Then the tool moves to the measured arm, the hand is
    // re-indexed to it, and this returns true: pose() and place() have changed.
    bool follow(const ArmFollow& status) noexcept;

    // Replaces the placed shapes from the next step on; drops those beyond the room made by the
    // constructor. Haptic thread, between steps.
    void setShapes(std::span<const Shape> shapes) noexcept {
        regions_.edited();
        tool_.setShapes(shapes);
    }

    const Pose& pose() const noexcept { return tool_.pose(); }     // base_T_tool
    const Pose& handle() const noexcept { return hand_.handle(); } // raw pose of the hand, last good sample
    ToolPlace place() const noexcept { return tool_.place(); }     // pose and, on an arm, posture
    // Of the next contact query: ahead of place() when answers are late. A pressed arm queries farther,
    // to distinguish a surface that moved back from one that vanished.
    QueryPlace queryPlace() const noexcept {
        QueryPlace next = ahead_.ask(place(), time_, tool_.jointCount());
        next.extraReach += std::min(pressed_.behindHand(tool_, hand_.springEnd()), QueryAhead::kMaxReach);
        return next;
    }
    bool onArm() const noexcept { return tool_.onArm(); }
    // active springs: those of the options, or softer ones while ticks are slow
    const Springs& springs() const noexcept { return watch_.springs(); }
    const PassivityController& passivity() const noexcept { return stage_.passivity(); }
    const HapticOptions& options() const noexcept { return options_; }
    // Steps with a number that is not finite.
    uint64_t notFinite() const noexcept { return stage_.notFinite(); }

    static constexpr double kRampTime = ForceRamps::kRampTime;

private:
    const ContactSet* chooseSet(const StepInput& input, StepRecord& out) noexcept;
    StepConditions conditionsOf(const StepInput& input, const ContactSet* set, StepRecord& out) noexcept;
    void takeSample(const StepInput& input, const StepConditions& conditions) noexcept;
    ProxyStep moveTool(const StepInput& input, const ContactSet* set, const StepConditions& conditions,
                       StepRecord& out) noexcept;
    SolvedStep solved(const ProxyStep& moved, const ContactSet* set) const noexcept;
    bool keepHandAtTool(const ContactSet* set, const StepPoses& before, ProxyStep& moved) noexcept;
    void shifted(const HandShift& shift) noexcept;
    WrenchInput wrenchInput(const StepInput& input, const StepConditions& conditions,
                            const ProxyStep& moved) const noexcept;
    void makeWrench(const WrenchInput& input, StepRecord& out) noexcept;

    HapticOptions options_;
    MappedHand hand_;
    ToolProxy tool_;
    PressedRegions pressed_;
    ActiveRegions regions_;
    DeviceLosses losses_;
    ArmHold armHold_;
    StiffnessWatch watch_;
    WrenchStage stage_;
    QueryAhead ahead_;
    Pose allowed_;            // base_T_tool that the active rows allowed in the last step
    double time_ = kNotKnown; // [s] of the last step
    bool placed_ = false;     // the tool moved to where the active set may not cover it
};

} // namespace fathom
