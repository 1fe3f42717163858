// SPDX-License-Identifier: Apache-2.0
#include "engine/types/camera_info.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

// Brown-Conrady: ideal ray -> distorted ray.
glm::dvec2 distort(const glm::dvec2& r, const std::array<double, 5>& d) noexcept {
    const auto [k1, k2, p1, p2, k3] = d;
    const double rr = r.x * r.x + r.y * r.y;
    const double radial = 1.0 + rr * (k1 + rr * (k2 + rr * k3));
    return {r.x * radial + 2.0 * p1 * r.x * r.y + p2 * (rr + 2.0 * r.x * r.x),
            r.y * radial + p1 * (rr + 2.0 * r.y * r.y) + 2.0 * p2 * r.x * r.y};
}

} // namespace

glm::dvec2 Intrinsics::ray(double u, double v) const noexcept {
    const glm::dvec2 seen{(u - cx) / fx, (v - cy) / fy};
    if (fan) {
        return {std::tan(seen.x), std::tan(seen.y) / std::cos(seen.x)};
    }
    if (!distorted()) {
        return seen;
    }
    glm::dvec2 r = seen;
    for (int i = 0; i < 100; ++i) { // converges for every lens whose distortion is monotone in the image
        const glm::dvec2 error = distort(r, distortion) - seen;
        r -= error;
        if (std::abs(error.x) + std::abs(error.y) < 1e-14) {
            break;
        }
    }
    return r;
}

glm::dvec2 Intrinsics::project(const dvec3& point) const noexcept {
    if (fan) {
        return {fx * std::atan2(point.x, point.z) + cx,
                fy * std::atan2(point.y, std::hypot(point.x, point.z)) + cy};
    }
    glm::dvec2 r{point.x / point.z, point.y / point.z};
    if (distorted()) {
        r = distort(r, distortion);
    }
    return {fx * r.x + cx, fy * r.y + cy};
}

double BeamSigma::across() const noexcept {
    return std::tan(0.5 * width) / std::sqrt(3.0);
}

double BeamSigma::at(double metres) const noexcept {
    return std::hypot(range + perMetre * metres, across() * metres);
}

double CameraInfo::sigmaAt(const dvec3& point) const noexcept {
    return beam ? beam->at(glm::length(point)) : depthSigma(point.z);
}

} // namespace fathom
