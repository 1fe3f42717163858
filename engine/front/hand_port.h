// SPDX-License-Identifier: Apache-2.0
// State of a HandPort that outlives its engine: the haptic cycle, its inputs, and the channels that the
// engine's threads fill.
#pragma once

#include "engine/front/core.h"
#include "engine/run/haptic_stepper.h"

#include <atomic>
#include <memory>

namespace fathom::front {

// Shared by the engine's threads and the hand port.
struct Shared {
    explicit Shared(const fathom::Scene& scene)
        : haptic(scene)
        , channels(kRows) {
        clock.start(-kPast);
    }
    HapticSide haptic;
    RunClock clock; // t = 0 is in the past, so that frames older than the engine keep their age
    Channels channels;
    std::atomic<bool> failed{false};
    std::atomic<bool> handOpen{false};

    static constexpr uint64_t kRows = 16;  // capacity of queues that are never read
    static constexpr double kPast = 100.0; // [s]
};

} // namespace fathom::front

namespace fathom::v0 {

// Haptic thread only.
struct HandPort::Impl {
    Impl(std::shared_ptr<front::Shared> from, const HandStart& start);
    Step step(const Hand& hand, Nanoseconds now) noexcept;

    std::shared_ptr<front::Shared> shared;
    std::unique_ptr<HapticCycle> cycle;
    HapticStepper stepper;
    Nanoseconds last = 0;
};

} // namespace fathom::v0
