// SPDX-License-Identifier: Apache-2.0
// Group feel, part two: hands that yield, and walls that come nearer.
#pragma once

#include "apps/stability/stability_case.h"

namespace fathom::stability {

void addFeelLoops(std::vector<Case>& cases);

// [m/s] steepest rise of the force over the stiffness, tick by tick, at a still hand while a clean wall comes
// nearer by `reach` [m] at `speed` [m/s]: the worst of `trials` runs that start at different times within a
// frame.
double approachRise(double speed, double reach, int trials);

} // namespace fathom::stability
