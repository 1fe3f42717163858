// SPDX-License-Identifier: Apache-2.0
// The gap that decides: the one formula of all contact queries, kernels and checks on the host. Their answers
// are equal to the last bit because all call it.
#pragma once

#include "engine/types/sphere_tree.h"

#include <cmath>

namespace fathom {

// |c - s| - (r + R) [m] in float64, left to right without contraction. leaf: of the tool. x, y, z, radius: of
// a region sphere, about the same origin.
inline double exactGap(const Sphere& leaf, float x, float y, float z, float radius) noexcept {
    const double dx = leaf.centre.x - static_cast<double>(x);
    const double dy = leaf.centre.y - static_cast<double>(y);
    const double dz = leaf.centre.z - static_cast<double>(z);
    return std::sqrt(dx * dx + dy * dy + dz * dz) - (leaf.radius + static_cast<double>(radius));
}

} // namespace fathom
