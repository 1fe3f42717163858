// SPDX-License-Identifier: Apache-2.0
// A noisy, bulging wall of region spheres: what the haptic side is measured on.
#pragma once

#include "engine/contact/fixtures.h"

namespace fathom::profile {

inline constexpr double kWallRadius = 0.04; // [m] of its spheres

// Height [m] of the wall's middle surface at x, y [m]; its slope is 0.2 at most.
double wallHeight(double x, double y);

// (2 half + 1)^2 spheres `spacing` [m] apart in x and y, about the origin, row by row; noise of 0.15 mm at
// most. The same for equal arguments.
Fixtures wavyWall(int half, double spacing);

} // namespace fathom::profile
