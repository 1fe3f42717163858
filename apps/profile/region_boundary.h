// SPDX-License-Identifier: Apache-2.0
// How far the boundary of one union of spheres lies from that of another, by rays that find the surface.
#pragma once

#include "engine/contact/fixtures.h"

#include <cstdint>

namespace fathom::profile {

struct BoundaryError {
    double max = 0.0, rms = 0.0; // [m] distance of points of the one boundary to the other region, both ways
    double worstInside = 0.0;    // [m] how deep a point of `all`'s boundary lies outside `kept`; 0 = covered
    uint32_t samples = 0;
};

// Draws points of the boundary of `all`: from outside, straight towards a random centre, by sphere tracing on
// the exact distance. The same for `kept`. The draws depend on the seed alone. Neither may be empty.
BoundaryError boundaryError(const RegionSpheres& all, const RegionSpheres& kept, uint32_t samples,
                            uint64_t seed);

} // namespace fathom::profile
