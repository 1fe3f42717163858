// SPDX-License-Identifier: Apache-2.0
// One haptic step with the channels of a run: from the newest scene and contact set to a record. Knows no
// device and never sleeps.
#pragma once

#include "engine/cycle/haptic_cycle.h"
#include "engine/run/active_contacts.h"
#include "engine/run/channels.h"
#include "engine/run/hand_check.h"
#include "engine/run/run_clock.h"

namespace fathom {

// Haptic thread only. Never allocates, locks, throws or waits.
class HapticStepper {
public:
    HapticStepper(HapticCycle& cycle, Channels& channels, const RunClock& clock)
        : cycle_(cycle)
        , channels_(channels)
        , clock_(clock)
        , period_(cycle.options().period) {}

    // Before the first step, on the run's clock: the hand is where the cycle starts.
    void begin() noexcept { check_.begin(cycle_.handle(), clock_.now()); }

    // Steps the cycle at `now` [s] on the run's clock and publishes the tool state, the arm setpoint and the
    // posture. The record stays valid until the next step. The step stops refining at `end` [s].
    const StepRecord& step(const HandSample& hand, double now, double end) noexcept;

    // The timing of the last step, as the loop measured it.
    struct Timing {
        double wokenLate = 0.0; // [s] from the due time to the start of the step
        bool late = false;      // ended more than one period after it was due
        uint32_t missed = 0;    // periods before this one without a step
    };
    // Hands the last step to the writer. Drops it when the queue is full.
    void log(const Timing& timing) noexcept;

    // At the end of a run: commands the arm to hold and lets it clear its faults.
    void releaseArm(double now) noexcept { sendSetpoint({}, true, now); }

    const TickRow& row() const noexcept { return row_; }
    const SceneUpdate& scene() const noexcept { return channels_.scene.front(); }
    double period() const noexcept { return period_; }       // [s] nominal
    double sinceLast() const noexcept { return sinceLast_; } // [s] since the step before; 0 = none
    RunClock::Time began() const noexcept { return began_; } // start of the last step, on the host's clock
    RunClock::Time ended() const noexcept { return ended_; }

private:
    struct Until { // context of a Deadline
        const RunClock* clock;
        double t;
        static bool passed(const void* context) noexcept;
    };
    void takeNewest() noexcept;
    void followArm(double now) noexcept;
    void sendSetpoint(const StepRecord& record, bool off, double now) noexcept;
    void publish(const HandSample& hand, double now) noexcept;

    HapticCycle& cycle_;
    Channels& channels_;
    const RunClock& clock_;
    double period_;
    ActiveContacts<LeasePool<ContactSet>::Lease> contacts_;
    HandCheck check_;
    TickRow row_;
    RunClock::Time began_, ended_;
    double before_ = 0.0; // [s] the step before
    double sinceLast_ = 0.0;
    bool first_ = true;
};

} // namespace fathom
