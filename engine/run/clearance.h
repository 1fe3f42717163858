// SPDX-License-Identifier: Apache-2.0
// The clearance: the smallest gap of the tool to the regions of points, also beyond the reach of the contact
// query. It is for logs and displays; no force depends on it.
#pragma once

#include "engine/run/contact_loop.h"

#include <algorithm>
#include <cmath>

namespace fathom {

inline constexpr double kClearancePeriod = 0.01; // [s] between measurements

// In real time: a thread of its own, so that no answer to the haptic thread waits for a measurement. It uses
// at most a tenth of a processor.
class ClearanceLoop {
public:
    ClearanceLoop(ContactAnswers& answers, Channels& channels, const RunClock& clock)
        : answers_(answers)
        , channels_(channels)
        , clock_(clock) {}

    // Measures at the newest tool pose until `stop`. Passes on exceptions of the measurement.
    void run(const std::atomic<bool>& stop);

private:
    ContactAnswers& answers_;
    Channels& channels_;
    const RunClock& clock_;
};

// In lockstep: measures in every n-th call, so that equal runs measure at equal ticks.
class SteppedClearance {
public:
    explicit SteppedClearance(double period) // [s] of a tick
        : every_(std::max(1l, std::lround(kClearancePeriod / period))) {}

    template <class Measure>
    void update(Measure&& measure) {
        gap_ = calls_++ % every_ == 0 ? measure() : gap_;
    }
    double gap() const { return gap_; } // [m]

private:
    long every_, calls_ = 0;
    double gap_ = kNotKnown;
};

} // namespace fathom
