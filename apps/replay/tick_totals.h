// SPDX-License-Identifier: Apache-2.0
// Totals over the haptic ticks of a run: the part of summary.json that the ticks alone determine.
#pragma once

#include "engine/run/channels.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fathom {

// Not thread-safe. Maxima and minima ignore values that are not finite. Memory: 4 bytes per tick (step
// times).
class TickTotals {
public:
    void add(const TickRow& row);

    uint64_t ticks = 0, late = 0, stalled = 0, trapped = 0, escape = 0, infeasible = 0, notFinite = 0;
    uint64_t waiting = 0;
    uint32_t vanished = 0;                  // times that regions disappeared while they pressed
    double indexShift = 0.0;                // [m] net displacement of the hand map
    double maxForce = 0.0, maxTorque = 0.0; // [N], [N m] largest norm
    double maxForceStep = 0.0; // [N] largest change between consecutive ticks; the first counts from zero
    std::optional<double> minMarginPassive, minMarginUncoupled;
    uint64_t solves = 0;
    std::vector<float> stepMicros;

private:
    dvec3 lastForce_{0.0};
};

} // namespace fathom
