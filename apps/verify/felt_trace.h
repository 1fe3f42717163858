// SPDX-License-Identifier: Apache-2.0
// What a hand felt: wrenches and hand positions of a run at the tick rate, and the figures that describe
// them.
#pragma once

#include "engine/types/wrench.h"

#include <cstdint>
#include <vector>

namespace fathom {

// One value per tick. Base frame. For one thread; allocates.
class FeltTrace {
public:
    explicit FeltTrace(double period = 0.001)
        : period_(period) {}

    void add(const Wrench& wrench, const dvec3& hand) {
        force_.push_back(wrench.force);
        torque_.push_back(wrench.torque);
        hand_.push_back(hand);
    }
    void clear() { force_.clear(), torque_.clear(), hand_.clear(); }

    size_t ticks() const { return force_.size(); }
    double time() const { return period_ * static_cast<double>(ticks()); } // [s]
    dvec3 meanForce() const;                                               // [N]
    double forceRms() const;                                               // [N] about the mean
    double torqueRms() const;                                              // [N m] about the mean
    double forceBand(double low, double high) const;  // [N] RMS of the part between two frequencies [Hz]
    double motionBand(double low, double high) const; // [m] likewise, of the hand
    double motionPeakToPeak() const;                  // [m] largest of the three axes
    double forceStep() const;                         // [N] largest change from tick to tick
    double torqueStep() const;                        // [N m]
    uint64_t stepsOver(double newton) const;          // ticks whose force changes by more
    // Ticks whose change of force points against that of the tick before, both larger than `newton`.
    uint64_t reversals(double newton) const;
    double steepestRise(double over) const; // [N/s] of the force's size, mean over `over` [s]
    // [N] half of the peak-to-peak force along `axis` (unit) within any stretch of `window` [s]: the median.
    double sawtooth(const dvec3& axis, double window) const;

private:
    double band(const std::vector<dvec3>& values, double low, double high) const;

    double period_;
    std::vector<dvec3> force_, torque_, hand_;
};

} // namespace fathom
