// SPDX-License-Identifier: Apache-2.0
// Distance between the boundaries of two unions of spheres, sampled with rays.
#pragma once

#include "engine/contact/host_fixtures.h"

#include <cstdint>

namespace fathom::profile {

struct BoundaryError {
    double max = 0.0, rms = 0.0; // [m] distance of boundary points to the other region, in both directions
    double worstInside = 0.0;    // [m] how far a boundary point of `all` is outside `kept`; 0 = covered
    uint32_t samples = 0;
};

// Samples boundary points of `all` and of `kept`: sphere tracing on the exact distance, from outside towards
// a random centre. Deterministic per seed. Neither region may be empty.
BoundaryError boundaryError(const RegionSpheres& all, const RegionSpheres& kept, uint32_t samples,
                            uint64_t seed);

} // namespace fathom::profile
