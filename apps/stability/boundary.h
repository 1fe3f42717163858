// SPDX-License-Identifier: Apache-2.0
// The stiffness at which a sampled spring becomes unstable, measured with the full loop and computed from a
// model.
#pragma once

#include "apps/stability/loop_rig.h"

namespace fathom::stability {

// Largest K_t [N/m] (K_r [N m/rad] when rotational) at which a swing about a line does not grow, by bisection
// to 1e-4. The device is released 2 mm (0.02 rad) off the line in the spec's hand, without force limits or
// passivity controller. Searches from guess / 8 to guess x 8.
double measuredBoundary(LoopSpec spec, double guess, bool rotational = false);

// Computes the same boundary: the largest K for which the exact discrete model has no eigenvalue outside the
// unit circle. The model has mass, damping, the hand's spring, zero-order hold, n ticks of delay, and virtual
// damping B by backward difference. Damping and B act at the device.
struct SampledLoop {
    double mass;           // [kg], or [kg m^2] when rotational
    double damping;        // [N s/m], or [N m s/rad]
    double handStiffness;  // [N/m], or [N m/rad]
    double period;         // [s]
    double virtualDamping; // as damping
    uint32_t delay;        // [ticks]
};
double computedBoundary(const SampledLoop& loop, double guess);

// Analytic boundary (b + B) / (T/2 + n T), exact for a heavy device. With B = 0 it is the passive bound.
// Units of SampledLoop.
double lawOfBoundary(double damping, double virtualDamping, double period, uint32_t delay);

} // namespace fathom::stability
