// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/moments.h"

namespace fathom::reference {

PointMoments moments(std::span<const dvec3> points) {
    PointMoments m;
    if (points.empty()) {
        return m;
    }
    m.count = static_cast<double>(points.size());
    const dvec3 anchor = points[0]; // a mean far from the origin keeps its digits
    dvec3 sum(0.0);
    for (const dvec3& p : points) {
        sum += p - anchor;
    }
    m.mean = anchor + sum / m.count;
    for (const dvec3& p : points) {
        const dvec3 d = p - m.mean;
        const std::array outer{d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
        for (size_t i = 0; i < outer.size(); ++i) {
            m.covariance[i] += outer[i] / m.count;
        }
    }
    return m;
}

std::vector<dvec3> pointsOfClass(std::span<const uint32_t> masks, const PointImage& points, size_t c) {
    std::vector<dvec3> out;
    for (size_t i = 0; i < masks.size(); ++i) {
        if ((masks[i] >> c & 1) != 0 && points.z[i] != 0.0) {
            out.push_back(points.at[i]);
        }
    }
    return out;
}

} // namespace fathom::reference
