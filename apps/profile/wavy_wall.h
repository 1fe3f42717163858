// SPDX-License-Identifier: Apache-2.0
// A noisy, wavy wall of region spheres for measurements of the haptic side.
#pragma once

#include "engine/contact/host_fixtures.h"

namespace fathom::profile {

inline constexpr double kWallRadius = 0.04; // [m] radius of its spheres

// Height [m] of the wall's mean surface at x, y [m]; the slope is at most 0.2.
double wallHeight(double x, double y);

// (2 half + 1)^2 spheres around the origin, `spacing` [m] apart in x and y, row by row, with noise of at most
// 0.15 mm. Deterministic.
HostFixtures wavyWall(int half, double spacing);

} // namespace fathom::profile
