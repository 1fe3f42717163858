// SPDX-License-Identifier: Apache-2.0
// Finds the nearest region sphere of each tool leaf in the fixture set's grid.
#pragma once

#include "engine/contact/region_grid.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace fathom {

// The result for one leaf.
struct NearestSphere {
    static constexpr uint32_t kNone = UINT32_MAX;
    uint32_t sphere = kNone;                            // index into the spheres of the grid
    float gap = std::numeric_limits<float>::infinity(); // [m] between the two surfaces; < 0 = overlap
};

// For each leaf (poseLeaves() about the set's origin), the sphere with the smallest gap <= limit [m], the
// first in grid order on ties; kNone if there is none. The gap is float32: sqrt(dx dx + dy dy + dz dz) - (r_t
// + R), left to right without contraction. Any thread; allocates `out` only.
void nearestSpheres(const PosedLeaves& leaves, float limit, const RegionGrid& grid,
                    std::vector<NearestSphere>& out);

} // namespace fathom
