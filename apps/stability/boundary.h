// SPDX-License-Identifier: Apache-2.0
// Where a sampled spring becomes unstable: measured with the whole loop, and computed.
#pragma once

#include "apps/stability/loop_rig.h"

namespace fathom::stability {

// Largest K_t [N/m] (K_r [N m/rad] when rotational) at which a swing about a line dies out or stays, by
// bisection to 1e-4: the device is let go 2 mm (0.02 rad) off the line, held by the spec's hand, no limits,
// no controller. `guess`: where to look, from guess / 8 to guess x 8.
double measuredBoundary(LoopSpec spec, double guess, bool rotational = false);

// The same, computed: the largest K for which the exact discrete model (mass, damping, hand's spring, hold, n
// ticks of delay, B by backward difference) has no eigenvalue outside the unit circle. damping and B at the
// device.
struct SampledLoop {
    double mass, damping, handStiffness, period, virtualDamping;
    uint32_t delay;
};
double computedBoundary(const SampledLoop& loop, double guess);

// The law: (b + B) / (T/2 + n T), exact for a heavy device; with B = 0 it is the passive bound.
double lawOfBoundary(double damping, double virtualDamping, double period, uint32_t delay);

} // namespace fathom::stability
