// SPDX-License-Identifier: Apache-2.0
// What the haptic ticks of a run add up to: the part of summary.json that follows from the tick records
// alone.
#pragma once

#include "apps/replay/tick_record.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fathom {

// Not thread-safe. Values that are not finite are left out of maxima and minima. Memory: 4 bytes per tick
// (the turn times).
class TickTotals {
public:
    void add(const TickRecord& tick);

    uint64_t ticks = 0, late = 0, stalled = 0, trapped = 0, escape = 0, infeasible = 0, notFinite = 0;
    double maxForce = 0.0, maxTorque = 0.0; // [N], [N m] of the vector's norm
    double maxForceStep = 0.0;              // [N] between neighbouring ticks; the first counts from zero
    std::optional<double> minMarginPassive, minMarginUncoupled;
    uint64_t solves = 0;
    std::vector<float> stepMicros;

private:
    dvec3 lastForce_{0.0};
};

} // namespace fathom
