// SPDX-License-Identifier: Apache-2.0
// The gap that decides: the one formula of all contact queries, kernels and checks on the host. Their answers
// are equal to the last bit because all call it.
#pragma once

#include <cmath>

namespace fathom {

// |c - s| - (r + R) [m] in float64, left to right without contraction. cx, cy, cz, r: centre and radius of a
// tool leaf. x, y, z, radius: of a region sphere, about the same origin.
inline double exactGap(double cx, double cy, double cz, double r, float x, float y, float z,
                       float radius) noexcept {
    const double dx = cx - static_cast<double>(x);
    const double dy = cy - static_cast<double>(y);
    const double dz = cz - static_cast<double>(z);
    return std::sqrt(dx * dx + dy * dy + dz * dz) - (r + static_cast<double>(radius));
}

} // namespace fathom
