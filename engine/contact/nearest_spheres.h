// SPDX-License-Identifier: Apache-2.0
// The nearest region sphere of each tool leaf, by the fixture set's grid.
#pragma once

#include "engine/contact/region_grid.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace fathom {

// The answer for one leaf.
struct NearestSphere {
    static constexpr uint32_t kNone = UINT32_MAX;
    uint32_t sphere = kNone;                            // index into what the grid was built from
    float gap = std::numeric_limits<float>::infinity(); // [m] between the two surfaces; < 0 = overlap
};

// Of each leaf (poseLeaves() about the set's origin) the sphere with the smallest gap among those with gap <=
// limit [m], of equal gaps the first in the grid's order; kNone where there is none. The gap is float32:
// sqrt(dx dx + dy dy + dz dz) - (r_t + R), left to right without contraction. Any thread; allocates `out`
// only.
void nearestSpheres(const PosedLeaves& leaves, float limit, const RegionGrid& grid,
                    std::vector<NearestSphere>& out);

} // namespace fathom
