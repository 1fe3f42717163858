// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/moments.comp: count, mean and covariance of points, two plain passes in float64.
#pragma once

#include "engine/reference/frame_view.h"

#include <array>

namespace fathom::reference {

struct PointMoments {
    double count = 0.0;
    dvec3 mean{0.0};                    // [m]
    std::array<double, 6> covariance{}; // xx xy xz yy yz zz [m^2], about the mean, divided by the count

    double trace() const { return covariance[0] + covariance[3] + covariance[5]; }
};
PointMoments moments(std::span<const dvec3> points);

// The points of class bit c in row-major order.
std::vector<dvec3> pointsOfClass(std::span<const uint32_t> masks, const PointImage& points, size_t c);

} // namespace fathom::reference
