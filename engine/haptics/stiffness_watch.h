// SPDX-License-Identifier: Apache-2.0
// Adapts the automatic stiffness while running: slower ticks lower the passive bound, and the springs follow
// it.
#pragma once

#include "engine/haptics/coupling.h"

namespace fathom {

// One thread; noexcept, no allocation. Springs set by the user do not change, nor do those of a device with
// unknown damping, whose bound is unknown.
class StiffnessWatch {
public:
    // planned: result of makeSprings() for these options, and the upper limit of springs().
    StiffnessWatch(const DevicePreset& preset, const CouplingOptions& options, const Springs& planned);

    // One tick: measured period [s], 0 = none (lockstep: nothing changes). The period is averaged over
    // kAverage; K_t and K_r ramp down to their bounds (the whole of K_t in kDown) and back up (in kUp), never
    // in a step. A late tick counts as at most kLateAlone, unless a recent one was late, too: the
    // longest of the ticks before counts, shrinking to kForget of itself per tick.
    void step(double measuredPeriod) noexcept;

    const Springs& springs() const noexcept { return springs_; } // active; k = sqrt(K_r / K_t) follows
    double period() const noexcept { return period_; }           // [s] averaged

    static constexpr double kAverage = 0.05;   // [s]
    static constexpr double kDown = 0.2;       // [s] for the whole of K
    static constexpr double kUp = 2.0;         // [s]
    static constexpr double kLateAlone = 0.01; // [s]
    static constexpr double kMinShare = 0.01;  // of the planned stiffness: lower limit of the ramp

private:
    static constexpr double kForget = 0.9;

    double wantedShare() const noexcept;

    std::optional<double> damping_, rotationalDamping_; // of the device, at the tool; empty = not watched
    CouplingOptions options_;
    Springs planned_, springs_;
    double share_ = 1.0; // of the planned K_t
    double period_;
    double before_ = 0.0; // [s] longest of the ticks before; in each tick it shrinks to kForget of itself
};

} // namespace fathom
