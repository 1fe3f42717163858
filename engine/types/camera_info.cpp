// SPDX-License-Identifier: Apache-2.0
#include "engine/types/camera_info.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

// Ideal ray -> distorted ray.
glm::dvec2 distort(const glm::dvec2& r, const Intrinsics& lens) noexcept {
    const double rr = r.x * r.x + r.y * r.y;
    if (lens.model == LensModel::Equidistant) {
        const auto [k1, k2, k3, k4, unused] = lens.distortion;
        const double length = std::sqrt(rr), t = std::atan(length), tt = t * t;
        const double bent = t * (1.0 + tt * (k1 + tt * (k2 + tt * (k3 + tt * k4))));
        return length > 0.0 ? r * (bent / length) : r;
    }
    const auto [k1, k2, p1, p2, k3] = lens.distortion;
    const auto [k4, k5, k6] = lens.divisor;
    const double radial = (1.0 + rr * (k1 + rr * (k2 + rr * k3))) / (1.0 + rr * (k4 + rr * (k5 + rr * k6)));
    const glm::dvec2 q = lens.model == LensModel::ScaledTangential ? r * radial : r;
    return {r.x * radial + 2.0 * p1 * q.x * q.y + p2 * (rr + 2.0 * q.x * q.x),
            r.y * radial + p1 * (rr + 2.0 * q.y * q.y) + 2.0 * p2 * q.x * q.y};
}

// Positive where a longer ray shows farther from the centre: the derivative of the radial distortion by the
// ray's length, times a positive factor. `rr` is the square of that length.
double spread(double rr, const Intrinsics& lens) noexcept {
    if (lens.model == LensModel::Equidistant) {
        const auto [k1, k2, k3, k4, unused] = lens.distortion;
        const double t = std::atan(std::sqrt(rr)), tt = t * t;
        return 1.0 + tt * (3.0 * k1 + tt * (5.0 * k2 + tt * (7.0 * k3 + tt * 9.0 * k4)));
    }
    const auto [k1, k2, p1, p2, k3] = lens.distortion;
    const auto [k4, k5, k6] = lens.divisor;
    const double above = 1.0 + rr * (k1 + rr * (k2 + rr * k3)),
                 aboveSlope = k1 + rr * (2.0 * k2 + rr * 3.0 * k3);
    const double below = 1.0 + rr * (k4 + rr * (k5 + rr * k6)),
                 belowSlope = k4 + rr * (2.0 * k5 + rr * 3.0 * k6);
    return std::min(below, above * below + 2.0 * rr * (aboveSlope * below - above * belowSlope));
}

// Sufficient for spread() > 0 up to rr, and quick: as if every negative coefficient acted alone.
bool spreadsTo(double rr, const Intrinsics& lens) noexcept {
    const bool angles = lens.model == LensModel::Equidistant;
    const auto& k = lens.distortion;
    const std::array<double, 4> c =
        angles ? std::array{k[0], k[1], k[2], k[3]} : std::array{k[0], k[1], k[4], 0.0};
    const auto less = [&](size_t i, double factor) { return factor * std::min(c[i], 0.0); };
    const double least =
        1.0 + rr * (less(0, 3.0) + rr * (less(1, 5.0) + rr * (less(2, 7.0) + rr * less(3, 9.0))));
    return least > 0.0 && lens.divisor == std::array<double, 3>{}; // an angle is smaller than its tangent
}

// Newton's method with numeric derivatives, for lenses too wide for the fixed-point iteration.
glm::dvec2 undistort(const glm::dvec2& seen, const Intrinsics& lens) noexcept {
    constexpr double kStep = 1e-6;
    const double angle = glm::length(seen);
    const bool angles = lens.model == LensModel::Equidistant && angle > 0.0 && angle < 1.48;
    glm::dvec2 r = angles ? seen * (std::tan(angle) / angle) : seen;
    for (int i = 0; i < 100; ++i) {
        const glm::dvec2 error = distort(r, lens) - seen;
        if (std::abs(error.x) + std::abs(error.y) < 1e-14) {
            break;
        }
        const glm::dvec2 dx = (distort(r + glm::dvec2(kStep, 0.0), lens) - seen - error) / kStep;
        const glm::dvec2 dy = (distort(r + glm::dvec2(0.0, kStep), lens) - seen - error) / kStep;
        const double det = dx.x * dy.y - dy.x * dx.y;
        r -= glm::dvec2(error.x * dy.y - dy.x * error.y, dx.x * error.y - error.x * dx.y) / det;
    }
    return r;
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
    if (model != LensModel::Polynomial || divisor != std::array<double, 3>{}) {
        return undistort(seen, *this);
    }
    glm::dvec2 r = seen;
    for (int i = 0; i < 100; ++i) { // converges for every lens whose distortion is monotone in the image
        const glm::dvec2 error = distort(r, *this) - seen;
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
    const glm::dvec2 straight{point.x / point.z, point.y / point.z};
    if (!distorted()) {
        return {fx * straight.x + cx, fy * straight.y + cy};
    }
    const glm::dvec2 r = distort(straight, *this);
    const glm::dvec2 pixel{fx * r.x + cx, fy * r.y + cy};
    const bool inside = pixel.x > -1.0 && pixel.y > -1.0 && pixel.x < width && pixel.y < height;
    const double length = glm::length(straight);
    // Outside the image it makes no difference whether the lens has folded it, so reach() is spared.
    return inside && !(length <= kMaxSlope && reach(length) >= length) ? glm::dvec2(kUnseen) : pixel;
}

double Intrinsics::reach(double most) const noexcept {
    constexpr double kStep = 0.01;
    if (spreadsTo(most * most, *this)) {
        return most;
    }
    for (double from = 0.0; distorted() && from < most; from += kStep) {
        double lo = from, hi = std::min(most, from + kStep);
        if (spread(hi * hi, *this) > 0.0) {
            continue;
        }
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (lo + hi);
            (spread(middle * middle, *this) > 0.0 ? lo : hi) = middle;
        }
        return lo;
    }
    return most;
}

bool Intrinsics::invertible() const noexcept {
    for (uint32_t i = 0; i < 25 && !fan; ++i) {
        const uint32_t column = i % 5, row = i / 5;
        const double u = 0.25 * column * (width - 1.0), v = 0.25 * row * (height - 1.0);
        const glm::dvec2 r = ray(u, v), back = project({r.x, r.y, 1.0});
        if (!(std::abs(back.x - u) < 1e-3) || !(std::abs(back.y - v) < 1e-3) ||
            (distorted() && !(glm::length(r) < kMaxSlope))) {
            return false;
        }
    }
    return true;
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
