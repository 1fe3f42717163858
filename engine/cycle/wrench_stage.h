// SPDX-License-Identifier: Apache-2.0
// The last part of a haptic step: from the poses of hand and tool to the wrench on the hand.
#pragma once

#include "engine/cycle/haptic_options.h"
#include "engine/haptics/force_ramps.h"
#include "engine/haptics/limits.h"
#include "engine/haptics/passivity.h"
#include "engine/haptics/reaction.h"

namespace fathom {

// Why a tick has a force: bits of StepRecord::cause.
namespace cause {
inline constexpr uint32_t kRow = 1;      // a region or shape pushes
inline constexpr uint32_t kJoint = 2;    // a limit of an arm's joint pushes
inline constexpr uint32_t kGuidance = 4; // guidance pulls, at most its limits
inline constexpr uint32_t kDamping = 8;  // energy that moving regions fed into the hand is dissipated
inline constexpr uint32_t kRamp = 16;    // the force fades out or returns
inline constexpr uint32_t kSlew = 32;    // the slew limit still holds back a change
} // namespace cause

// Input of one tick. Base frame.
struct WrenchInput {
    Pose allowed;   // ProxyStep::allowed
    Pose springEnd; // the hand's end of the spring: device pose moved by the guidance lead
    Pose device;    // that the hand commands
    dquat baseRhandle{1.0, 0.0, 0.0, 0.0};
    Springs springs;       // active
    Wrench pull;           // of guidance, part of the wrench
    uint32_t pushes = 0;   // cause::kRow and kJoint of the solver's answer
    bool bothWays = false; // only lines and axes hold the tool: on both sides
    bool mayRise = true;   // as ReactionInput
    bool newData = false;  // as ReactionInput
    bool lags = false;     // as ReactionInput
    bool escape = false;   // new data covers the tool, which is on its way out
    bool vanished = false; // as ReactionInput
    bool forcesOn = false; // running, not switched off, no clutch
    bool off = false;      // forces off or dead-man open: the next rise takes HapticOptions::softStartTime
    bool trapped = false;
    bool stale = false;
    bool sampleFinite = true; // false: the hand's sample is not finite, and there is no force in this tick
    bool rendered = true;     // false: the device renders nothing in this tick, whatever is written
    double elapsed = 0.001;   // [s] measured since the tick before; nominal in lockstep
};

// One thread; noexcept, no allocation. Guarantees for any input:
// - Force and torque stay within their limits, and rise at most by the slew limits.
// - What is no longer wanted, such as a force that must turn round, ends within ForceRamps::kRampTime, or
//   within the ticks that a fast slew limit needs.
// - After a fade, or a tick that the device did not render, the force rises from there within the ramp.
class WrenchStage {
public:
    explicit WrenchStage(const HapticOptions& options);

    // Result of one step.
    struct Output {
        Wrench wrench;    // on the hand, after all limits, before projection
        Wrench delivered; // on the actuated axes
        Wrench residual;  // wrench - delivered
        uint32_t cause = 0;
        bool finite = true; // false: some number was not finite, and the wrench is zero
    };
    Output step(const WrenchInput& input) noexcept;

    // The hand's end of the spring was moved by `by` [m] and turned by `turn`, not by the hand.
    void shift(const dvec3& by, const dquat& turn) noexcept;
    // Tool and hand start anew at `pose`, without force.
    void restart(const Pose& pose) noexcept { deviceBefore_ = pose; }

    bool off() const noexcept { return ramps_.off() && isZero(previous_); } // ramped out, or never on
    bool fades() const noexcept { return reaction_.fades(); }     // the force of regions that are gone
    double reaction() const noexcept { return reaction_.size(); } // [N] of the last tick
    const PassivityController& passivity() const noexcept { return passivity_; }
    uint64_t notFinite() const noexcept { return notFinite_; }

private:
    void stepRamps(const WrenchInput& input) noexcept;
    Wrench springWrench(const WrenchInput& input) noexcept;
    dvec3 slewed(const dvec3& wanted, const dvec3& before, double slew, double limit,
                 double elapsed) const noexcept;
    Wrench smoothed(const WrenchInput& input, const Wrench& wanted) noexcept;
    Wrench damping(const WrenchInput& input, const Wrench& reaction) noexcept;
    Wrench passivityWrench(const WrenchInput& input, const Wrench& reaction) noexcept;
    void reportToPassivity(const WrenchInput& input, const Wrench& damper, const Wrench& requested,
                           const Wrench& sized, const Wrench& delivered) noexcept;
    uint32_t causeOf(const WrenchInput& input, const Wrench& damper, const Wrench& sized,
                     const Wrench& slewed) const noexcept;
    Wrench onActuatedAxes(const WrenchInput& input, const Wrench& wrench) const noexcept;
    void cut() noexcept;

    const HapticOptions& options_;
    Reaction reaction_;
    PassivityController passivity_;
    ForceRamps ramps_;
    Wrench smooth_;         // low-pass
    Wrench previous_;       // rendered, for the slew limit
    Pose deviceBefore_;     // at the end of the previous tick, for the damping
    bool softStart_ = true; // forces return after they were off: within HapticOptions::softStartTime
    uint64_t notFinite_ = 0;
};

} // namespace fathom
