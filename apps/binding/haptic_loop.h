// SPDX-License-Identifier: Apache-2.0
// The haptic cadence in real time: read the hand, one turn, write the wrench, in the same tick. Never
// allocates, locks, throws or waits for anybody.
#pragma once

#include "apps/binding/crossings.h"
#include "apps/binding/run_clock.h"
#include "devices/haptic_device.h"
#include "engine/cycle/cadence_trace.h"
#include "engine/cycle/haptic_cycle.h"

namespace fathom {

class HapticLoop {
public:
    struct Ends {                        // the run is over when the hand's path and the frames both are
        double pathDuration = 0.0;       // [s]
        double framePeriod = 1.0 / 30.0; // [s] that the last frame is shown
    };
    HapticLoop(HapticCycle& cycle, HapticDevice& hand, Crossings& crossings, const RunClock& clock,
               const Ends& ends, CadenceTrace* trace);

    // Ticks by the clock until the end or `stop`; the last thing that the hand gets is a zero wrench. A
    // period that a late turn ran over is left out and counted: turns never come in bursts.
    void run(const std::atomic<bool>& stop) noexcept;

    // One turn, due at `due` [s] and started now; the tick that run() does. Returns when it was over [s].
    double step(double due) noexcept;

    uint64_t missed() const { return missed_; } // periods without a turn

private:
    struct Until { // of Deadline
        const RunClock* clock;
        double t;
        static bool passed(const void* context) noexcept;
    };
    bool ended(double t) const noexcept;
    void offerNewest() noexcept;
    void hearArm(TickRow& row) noexcept;
    void tellArm(const StepRecord& record, bool off) noexcept;
    StepInput inputFor(double now, const HandSample& sample, const Until& until) const noexcept;
    void report(const StepRecord& record, const HandSample& hand, const ToolState& start, double due,
                double began, double took, double over, TickRow& row) noexcept;

    HapticCycle& cycle_;
    HapticDevice& hand_;
    Crossings& crossings_;
    const RunClock& clock_;
    Ends ends_;
    CadenceTrace* trace_;
    double period_;
    LeasePool<ContactSet>::Lease inForce_, offered_;
    double before_ = 0.0; // [s] start of the turn before
    bool first_ = true;
    uint32_t missedNow_ = 0;
    uint64_t missed_ = 0;
};

} // namespace fathom
