// SPDX-License-Identifier: Apache-2.0
// The haptic cadence in real time: reads the hand, takes one step and writes the wrench, once per tick.
#pragma once

#include "engine/cycle/cadence_trace.h"
#include "engine/run/haptic_stepper.h"
#include "engine/types/frame.h"
#include "engine/types/haptic_device.h"

namespace fathom {

// Never allocates, locks, throws or waits, except for the next tick.
class HapticLoop {
public:
    struct Ends {                  // the run ends when both the hand's path and the frames have ended
        double pathDuration = 0.0; // [s]
        double framePeriod = kLockstepFramePeriod; // [s] duration of the last frame
    };
    HapticLoop(HapticCycle& cycle, HapticDevice& hand, Channels& channels, const RunClock& clock,
               const Ends& ends, CadenceTrace* trace);

    // Runs ticks by the clock until the end, `ending` (set by the other threads) or `userStop`. The last
    // wrench written is zero. A period that a late step overran is skipped and counted, so steps never come
    // in bursts.
    void run(const std::atomic<bool>& ending, const std::atomic<bool>& userStop) noexcept;

    // One tick as in run(), due at `due` [s] and started now. Returns its end time [s].
    double step(double due) noexcept;

    uint64_t missed() const { return missed_; } // periods without a step

private:
    bool ended(double t) const noexcept;

    HapticStepper stepper_;
    HapticDevice& hand_;
    Channels& channels_;
    const RunClock& clock_;
    Ends ends_;
    CadenceTrace* trace_;
    double period_;
    uint32_t missedNow_ = 0;
    uint64_t missed_ = 0;
};

} // namespace fathom
