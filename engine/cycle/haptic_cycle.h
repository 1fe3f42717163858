// SPDX-License-Identifier: Apache-2.0
// One step of the haptic cadence: from the hand's pose to the wrench, in the same tick.
#pragma once

#include "engine/cycle/arm_setup.h"
#include "engine/cycle/haptic_options.h"
#include "engine/cycle/query_ahead.h"
#include "engine/cycle/step_record.h"
#include "engine/cycle/wrench_stage.h"
#include "engine/haptics/hand_map.h"
#include "engine/haptics/stiffness_watch.h"

#include <bitset>
#include <limits>
#include <optional>

namespace fathom {

// Haptic thread only. Allocates only in the constructor; step() never locks, throws, waits or uses Vulkan.
// The caller owns the device, the clock and the contact sets. Rules of a step:
// - Until the first contact set (when the scene needs one): the tool is held, the wrench is zero, the state
//   is off.
// - The regions' force is the reaction of active rows (Reaction). A tool that lags behind the hand for
//   another reason (late contact answers, slow joints) pulls with no force: the state is waiting, and after
//   kLagTime the hand map takes up the lag of a free tool.
// - Regions that disappear while they press, for a free tool also some of them: tool and hand stay, their
//   force fades out.
// - Forces off or dead-man open: the guidance weight and the wrench ramp to zero over 0.2 s while the tool
//   follows the hand and still obeys the regions.
// - Trapped: the tool is held and the force ramps out over 0.2 s. The clutch ramps the same way.
// - The clutch while forces are off and ramped out moves the hand map, so that the hand is at the tool again.
// - Scene older than kStaleAfter: the force fades out in 0.5 s. Fading out uses measured time, so late ticks
//   cannot delay it.
// - A force that returns is bounded by a share of the limits that rises from what the device renders
//   (ForceRamps); rising counts ticks.
// - Device gone or silent: nothing is rendered in that step, and recorded as such. The tool stays and the
//   hand is re-indexed when it is back. Three losses within 1 s keep the forces off until 1 s is clean.
// - While a real arm follows (follow()): if it stands still, or must (forces off, old frame, broken sample),
//   the tool is held and the force ramps out over 0.2 s. Then the tool moves to the measured arm and the hand
//   is re-indexed to it.
// - A number that is not finite: zero wrench in that step, which is counted; the force then returns from
//   zero.
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

    // Call before a step when a real arm follows; from the first call on, the rules above apply. Returns true
    // when the tool moved to the measured arm, which changes pose() and place().
    bool follow(const ArmFollow& status) noexcept;

    // Replaces the placed shapes from the next step on; drops those beyond the room made by the
    // constructor. Haptic thread, between steps.
    void setShapes(std::span<const Shape> shapes) noexcept {
        regions_.edited = true;
        arm_ ? arm_->setShapes(shapes) : proxy_->setShapes(shapes);
    }

    const Pose& pose() const { return tool_; }     // base_T_tool
    const Pose& handle() const { return handle_; } // raw pose of the hand, last good sample
    // Pose and, on an arm, posture.
    ToolPlace place() const { return {tool_, arm_ ? arm_->posture() : ArmPosture{}}; }
    // Of the next contact query: ahead of place() when answers are late. A pressed arm queries farther,
    // to distinguish a surface that moved back from one that vanished.
    QueryPlace queryPlace() const noexcept {
        QueryPlace next = ahead_.ask(place(), time_, arm_ ? armSetup_->model.count() : 0);
        next.extraReach += std::min(behindHand(), QueryAhead::kMaxReach);
        return next;
    }
    bool onArm() const { return arm_.has_value(); }
    // active springs: those of the options, or softer ones while ticks are slow
    const Springs& springs() const { return watch_.springs(); }
    const PassivityController& passivity() const { return stage_.passivity(); }
    const HapticOptions& options() const { return options_; }
    uint64_t notFinite() const { return stage_.notFinite(); } // steps with a number that is not finite

    static constexpr double kRampTime = ForceRamps::kRampTime;

private:
    static constexpr double kLagLength = 1e-4; // [m] a smaller lag counts as none
    static constexpr double kLagTime = 0.05;   // [s] of lag before the hand map takes it up
    static constexpr double kTakeUpTime = 0.2; // [s] time constant of that
    // [m] If every region is farther away than this, those that pressed have vanished.
    static constexpr double kVanishedGap = 0.002;
    static constexpr double kResumeWithin = 0.005; // [m] tool to hand, before an arm moves again

    struct Situation {            // what the rules depend on
        bool sampleFinite = true; // the hand's sample is finite
        bool off = false;         // forces off, dead-man open or device lost
        bool clutch = false;
        bool recentre = false; // the clutch's button is down, and there is no force
        bool setReady = false; // there is a set, or none is needed
        bool stale = false;
        bool armStill = false;  // a real arm stands still
        bool movesTool = false; // the tool is moved in this step
    };

    const ContactSet* chooseSet(const StepInput& input, StepRecord& out) noexcept;
    Situation situationOf(const StepInput& input, const ContactSet* set, StepRecord& out) noexcept;
    double sceneAge(const StepInput& input, const ContactSet* set) noexcept;
    bool accepts(const ContactSet& set) noexcept;
    ProxyStep moveTool(const StepInput& input, const ContactSet* set, bool newData, StepRecord& out) noexcept;
    void freeDirection(ProxyStep& moved) noexcept;
    ProxyStep stepTool(const StepInput& input, const ContactSet* set, const Situation& situation,
                       bool newData, StepRecord& out) noexcept;
    ProxyStep moveArm(const StepInput& input, const ProxyInput& wanted, StepRecord& out) noexcept;
    std::span<const Shape> shapes() const noexcept { return arm_ ? arm_->shapes() : proxy_->shapes(); }
    double leafRadius(uint32_t leaf) const noexcept {
        return arm_ ? arm_->leafRadius(leaf) : leafRadius_[leaf];
    }
    bool lossesHoldForces(const StepInput& input) noexcept;
    void recentre() noexcept;
    void takeSample(const StepInput& input, const Situation& situation) noexcept;
    bool regionsChanged(const ContactSet* set) noexcept;
    std::optional<dvec3> vanishedAlong(const ProxyStep& moved, const ContactSet* set, const Pose& before,
                                       const Pose& endBefore) const noexcept;
    bool handLeft(const Pose& before, const Pose& endBefore) const noexcept;
    bool turnVanished(const ProxyStep& moved, const Pose& endBefore) const noexcept;
    double behindHand() const noexcept;
    bool wentBack(const ContactSet* set, const dvec3& out) const noexcept;
    Pose guidedEnd() const noexcept;
    void keepHandAtTool(const Pose& before, const Pose& endBefore, const dvec3& along,
                        ProxyStep& moved) noexcept;
    void takeUpLag(ProxyStep& moved, StepRecord& out) noexcept;
    void shiftHand(const dvec3& by, const dquat& turn) noexcept;
    void makeWrench(const StepInput& input, const Situation& situation, const ProxyStep& moved, bool newData,
                    bool vanished, StepRecord& out) noexcept;
    void notePressing(const ProxyStep& moved, const StepRecord& out) noexcept;
    Wrench guidancePull() const noexcept;
    void recordTouches(const ContactSet* set, const ProxyStep& moved, StepRecord& out) const noexcept;
    void report(const Situation& situation, const ProxyStep& moved, bool hasSet,
                StepRecord& out) const noexcept;
    StepState stateOf(const Situation& situation, const ProxyStep& moved, bool lags) const noexcept;
    void holdArm(const Situation& situation, bool trapped, StepRecord& out) noexcept;
    void fillMargins(const StepInput& input, StepRecord& out) const noexcept;

    HapticOptions options_;
    HandMap map_;
    Guidance guidance_;
    const ArmSetup* armSetup_;
    std::optional<ArmProxy> arm_; // exactly one of these two exists
    std::optional<Proxy> proxy_;
    StiffnessWatch watch_;
    WrenchStage stage_;
    QueryAhead ahead_;

    std::vector<double> leafRadius_; // [m]
    Pose tool_;                      // base_T_tool after the last step
    Pose springEnd_;          // base_T_tool that the solver aims at: device pose moved by the guidance lead
    Pose allowed_;            // base_T_tool that the active rows allow
    Pose device_, handle_;    // last good sample: mapped, raw
    double time_ = kNotKnown; // [s] of the last step

    // The active regions of this step.
    struct ActiveRegions {
        uint64_t generation = 0;
        bool edited = false;                                  // shapes were replaced
        double age = std::numeric_limits<double>::infinity(); // [s]
    } regions_;
    struct Pressing {             // of the last step
        bool rows = false;        // with a force that can be felt, or the length that holds with soft springs
        dvec3 spring{0.0};        // [m] from the hand's end of the spring to where the rows held the tool
        std::bitset<64> fixtures; // rows of Scene::fixtures whose points pressed, modulo 64
    } pressing_;
    struct HandShift {
        double lagTime = 0.0;  // [s] for which the tool has been lagging
        dvec3 total{0.0};      // [m] of the hand map, over the run
        uint32_t vanished = 0; // times that pressed regions vanished, over the run
    } handShift_;
    struct Losses {
        bool present = true;
        std::array<double, 3> at{-1e9, -1e9, -1e9}; // [s] the last three
        bool many = false;                          // until 1 s is clean
    } losses_;
    struct RealArm {
        bool commandsHold = true; // StepRecord::armHold of the last step
        bool connected = false;   // a real arm is connected
        bool follows = false;     // and reports that it follows
        bool wasStill = true;     // Situation::armStill of the last step
        bool placed = false;      // the tool moved to where the active set may not cover it
    } realArm_;
    uint32_t jointLimits_ = 0; // active position limits of joints in the last step
};

} // namespace fathom
