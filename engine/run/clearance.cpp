// SPDX-License-Identifier: Apache-2.0
#include "engine/run/clearance.h"

namespace fathom {

namespace {

constexpr double kRest = 9.0; // pause after a measurement, in units of its duration

} // namespace

void ClearanceLoop::run(const std::atomic<bool>& stop) {
    while (!stop.load(std::memory_order_relaxed)) {
        const double began = clock_.now();
        if (channels_.clearanceAt.refresh()) {
            channels_.clearance.back() = answers_.clearance(channels_.clearanceAt.front());
            channels_.clearance.publish();
        }
        const double ended = clock_.now();
        clock_.sleepUntil(ended + std::clamp(kRest * (ended - began), kClearancePeriod, 0.5), stop);
    }
}

} // namespace fathom
