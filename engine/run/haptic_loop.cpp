// SPDX-License-Identifier: Apache-2.0
#include "engine/run/haptic_loop.h"

#include <algorithm>
#include <cmath>

namespace fathom {

HapticLoop::HapticLoop(HapticCycle& cycle, HapticDevice& hand, Channels& channels, const RunClock& clock,
                       const Ends& ends, CadenceTrace* trace)
    : stepper_(cycle, channels, clock)
    , hand_(hand)
    , channels_(channels)
    , clock_(clock)
    , ends_(ends)
    , trace_(trace)
    , period_(cycle.options().period) {}

bool HapticLoop::ended(double t) const noexcept {
    const SceneUpdate& scene = stepper_.scene();
    const bool frames =
        scene.live || scene.gone || (scene.sourceEnded && t >= scene.captureTime + ends_.framePeriod);
    return frames && t >= ends_.pathDuration;
}

void HapticLoop::run(const std::atomic<bool>& ending, const std::atomic<bool>& userStop) noexcept {
    uint64_t slot = 0;
    stepper_.begin();
    while (!ending.load(std::memory_order_relaxed) && !userStop.load(std::memory_order_relaxed)) {
        const double due = static_cast<double>(slot) * period_;
        clock_.sleepUntil(due);
        const double woken = clock_.now();
        if (ended(woken)) {
            break;
        }
        const double finished = step(due);
        // At most one step per period, however late this one was.
        const auto ran = static_cast<uint64_t>(std::max(0.0, woken / period_));
        const auto now = static_cast<uint64_t>(std::max(0.0, finished / period_));
        const uint64_t next = std::max(std::max(ran, slot) + 1, now);
        missedNow_ = static_cast<uint32_t>(next - slot - 1);
        missed_ += missedNow_;
        slot = next;
    }
    hand_.write(Wrench{}, period_);
    stepper_.releaseArm(clock_.now());
    channels_.hapticDone.store(true, std::memory_order_release);
}

double HapticLoop::step(double due) noexcept {
    const double began = clock_.now();
    const HandSample sample = hand_.read(std::max(0.0, began));
    const double end = (std::floor(began / period_) + 1.0) * period_; // of the period that began is in
    const StepRecord& record = stepper_.step(sample, began, end);
    hand_.write(record.deviceWrench, stepper_.sinceLast() > 0.0 ? stepper_.sinceLast() : period_);
    const double finished = clock_.now();
    stepper_.log({began - due, finished > due + period_, missedNow_});
    if (trace_ != nullptr) {
        trace_->step(stepper_.began(), stepper_.ended(), began - due);
    }
    return finished;
}

} // namespace fathom
