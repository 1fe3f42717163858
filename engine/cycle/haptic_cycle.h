// SPDX-License-Identifier: Apache-2.0
// One step of the haptic cadence: from the hand's pose to the wrench, in the same tick.
#pragma once

#include "engine/cycle/arm_rig.h"
#include "engine/cycle/haptic_options.h"
#include "engine/cycle/step_record.h"
#include "engine/haptics/hand_map.h"
#include "engine/haptics/passivity.h"
#include "engine/haptics/stiffness_watch.h"

#include <optional>

namespace fathom {

// Haptic thread only. Allocates only in the constructor; step() never locks, throws, waits or uses Vulkan.
// The caller owns the device, the clock and the contact sets. Rules of a step:
// - Until the first contact set (when the scene needs one): the tool is held, the wrench is zero, the state
// is off.
// - Forces off or dead-man open: the guidance weight is zero in that step; the wrench ramps to zero over 0.2
// s while the tool follows the hand
//   and still obeys the regions.
// - Trapped: the tool is held and the force ramps out over 0.2 s; it ramps in again when a motion is found.
// The clutch ramps
//   the same way.
// - Scene older than staleAfter: the force fades out over 0.5 s and returns when a frame arrives. Fading out
// uses measured time, so
//   late ticks cannot delay it; fading in counts ticks.
// - A real arm follows the tool (follow()) and stands still, or must because forces are off, the scene is old
// or the sample is
//   broken: the tool is held and the force ramps out over 0.2 s; then the tool moves to the measured arm and
//   the hand is re-indexed to it, so that both resume from there.
// - A number that is not finite: zero wrench in that step, which is counted; the next wrench slews up from
// zero.
class HapticCycle {
public:
    // start: raw pose of the hand before the first step. The tool starts where the hand commands it or, if
    // given, at base_T_tool `tool0`, with the hand map aligned as after a clutch. arm: null = the tool moves
    // freely. Otherwise it must outlive this, the tool is its tip and starts there (tool0, if given, only
    // requests the alignment), and contact sets refer to ArmRig::toolAt().
    HapticCycle(const Tool& tool, std::span<const Shape> shapes, const HapticOptions& options,
                const Pose& start, const Pose* tool0 = nullptr, const ArmRig* arm = nullptr);

    StepRecord step(const StepInput& input) noexcept;

    // Call before a step when a real arm follows; from the first call on, the rules above apply. Returns true
    // when the tool moved to the measured arm, which changes pose() and place().
    bool follow(const ArmFollow& told) noexcept;

    // Replaces the authored shapes from the next step on; drops those beyond the room made by the
    // constructor. Haptic thread, between steps.
    void setShapes(std::span<const Shape> shapes) noexcept {
        arm_ ? arm_->setShapes(shapes) : proxy_->setShapes(shapes);
    }

    const Pose& pose() const { return tool_; } // base_T_tool for the next contact query
    // Pose and, on an arm, posture.
    ToolState place() const { return {tool_, arm_ ? arm_->posture() : ArmPosture{}}; }
    bool onArm() const { return arm_.has_value(); }
    const Springs& springs() const {
        return watch_.springs();
    } // active springs: those of the options, or softer ones while ticks are slow
    const PassivityController& passivity() const { return passivity_; }
    const HapticOptions& options() const { return options_; }
    uint64_t notFinite() const { return notFinite_; } // steps with a number that is not finite

    static constexpr double kRampTime = 0.2;       // [s] forces off, clutch, trapped
    static constexpr double kFadeTime = 0.5;       // [s] old scene
    static constexpr double kResumeWithin = 0.005; // [m] tool to hand, before an arm moves again

private:
    struct Ramps {          // 0..1 each; their product scales the wrench
        double power = 0.0; // forces on, dead-man closed, clutch up
        double free = 1.0;  // not trapped
        double fresh = 1.0; // scene young enough
        double product() const { return power * free * fresh; }
    };
    struct Situation {    // what the rules depend on
        bool sane = true; // the hand's sample is finite
        bool off = false; // forces off or dead-man open
        bool clutch = false;
        bool running = false; // there is a set, or none is needed
        bool stale = false;
        bool held = false; // a real arm stands still
    };

    const ContactSet* chooseSet(const StepInput& input, StepRecord& out) noexcept;
    double sceneAge(const StepInput& input, const ContactSet* set) noexcept;
    bool covers(const ContactSet& set) noexcept;
    ProxyStep moveTool(const StepInput& input, const ContactSet* set, StepRecord& out) noexcept;
    void freeDirection() noexcept;
    ProxyStep moveArm(const StepInput& input, const ProxyInput& wanted, StepRecord& out) noexcept;
    std::span<const Shape> shapes() const noexcept { return arm_ ? arm_->shapes() : proxy_->shapes(); }
    double leafRadius(uint32_t leaf) const noexcept {
        return arm_ ? arm_->leafRadius(leaf) : leafRadius_[leaf];
    }
    void stepRamps(const Situation& now, bool trapped, double measured) noexcept;
    Wrench springWrench() noexcept;
    Wrench guidancePull() const noexcept;
    Wrench passivityWrench(const Wrench& spring, const Wrench& pull, double period) noexcept;
    Wrench onActuatedAxes(const Wrench& wrench) const noexcept;
    void finishWrench(const Wrench& spring, double period, const Situation& now, StepRecord& out) noexcept;
    void tellPassivity(const Wrench& pull, const Wrench& damper, const Wrench& asked, const Wrench& sized,
                       const Wrench& delivered) noexcept;
    void recordTouches(const ContactSet* set, const ProxyStep& moved, StepRecord& out) const noexcept;
    void report(const Situation& now, const ProxyStep& moved, bool hasSet, StepRecord& out) const noexcept;
    StepState stateOf(const Situation& now, const ProxyStep& moved) const noexcept;
    void holdArm(const Situation& now, bool trapped, StepRecord& out) noexcept;
    void fillMargins(const StepInput& input, StepRecord& out) const noexcept;

    HapticOptions options_;
    HandMap map_;
    Guidance guidance_;
    const ArmRig* rig_;
    std::optional<ArmProxy> arm_; // exactly one of these two exists
    std::optional<Proxy> proxy_;
    StiffnessWatch watch_;
    PassivityController passivity_;

    std::vector<double> leafRadius_; // [m]
    Pose tool_;                      // base_T_tool after the last step
    Pose springEnd_;       // base_T_tool that the solver aims at: device pose moved by the guidance lead
    Pose device_, handle_; // last good sample: mapped, raw
    Pose toolBefore_, deviceBefore_; // at the end of the previous step, for the damping
    Wrench smooth_;                  // low-pass
    Wrench previous_;                // delivered, for the slew limit
    Ramps ramps_;
    double age_ = 0.0;
    bool hasAge_ = false;
    bool armHold_ = true;
    bool followed_ = false;   // a real arm is connected
    bool armFollows_ = false; // and reports that it follows
    bool held_ = true;        // Situation::held of the last step
    bool placed_ = false;     // the tool moved to where the active set may not cover it
    bool arming_ = true;      // forces return after they were off: within HapticOptions::armTime
    uint64_t notFinite_ = 0;
};

} // namespace fathom
