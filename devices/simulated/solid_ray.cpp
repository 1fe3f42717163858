// SPDX-License-Identifier: Apache-2.0
// Where a ray enters each kind of solid: closed forms, and a march on the distance for the torus.
#include "devices/simulated/solid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

constexpr double kMiss = HUGE_VAL;

// First root of |o + t d|^2 = radius^2 over the first `axes` coordinates, from outside; d need not be unit
// there.
double enterRound(const dvec3& o, const dvec3& d, double radius, int axes) noexcept {
    double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y - radius * radius;
    if (axes == 3) {
        a += d.z * d.z;
        b += o.z * d.z;
        c += o.z * o.z;
    }
    const double discriminant = b * b - a * c;
    if (c <= 0.0 || b >= 0.0 || discriminant < 0.0) {
        return kMiss;
    }
    // c / (-b + sqrt) is the near root without cancellation, since b < 0.
    return c / (-b + std::sqrt(discriminant));
}

double enterBall(const dvec3& o, const dvec3& d, const dvec3& centre, double radius) noexcept {
    return enterRound(o - centre, d, radius, 3);
}

// Slabs. A ray parallel to a face divides by zero: the infinities sort themselves out, and min and max in
// this order drop the one possible NaN (a ray in the face's own plane).
double enterBox(const dvec3& o, const dvec3& d, const dvec3& half) noexcept {
    double in = 0.0, out = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
        const double inverse = 1.0 / d[axis];
        const double low = (-half[axis] - o[axis]) * inverse, high = (half[axis] - o[axis]) * inverse;
        in = std::max(in, std::min(low, high));
        out = std::min(out, std::max(low, high));
    }
    return in > 0.0 && in <= out ? in : kMiss;
}

double enterPlane(const dvec3& o, const dvec3& d) noexcept {
    return o.z > 0.0 && d.z < 0.0 ? -o.z / d.z : kMiss;
}

// The mantle |z| <= half of a round tube, without its ends.
double enterMantle(const dvec3& o, const dvec3& d, double radius, double half) noexcept {
    const double t = enterRound(o, d, radius, 2);
    return t < kMiss && std::abs(o.z + t * d.z) <= half ? t : kMiss;
}

double enterCapsule(const dvec3& o, const dvec3& d, double radius, double half) noexcept {
    if (const double t = enterMantle(o, d, radius, half); t < kMiss) {
        return t;
    }
    const dvec3 across(o.x, o.y, o.z - glm::clamp(o.z, -half, half));
    if (glm::dot(across, across) <= radius * radius) {
        return kMiss; // starts inside; the far ball is no way in
    }
    // A ray that does not enter by the mantle enters by the nearer of its two balls, if it enters at all.
    return std::min(enterBall(o, d, {0.0, 0.0, -half}, radius), enterBall(o, d, {0.0, 0.0, half}, radius));
}

double enterCylinder(const dvec3& o, const dvec3& d, double radius, double half) noexcept {
    if (const double t = enterMantle(o, d, radius, half); t < kMiss) {
        return t;
    }
    const double side = o.z < 0.0 ? -half : half; // only the cap on the origin's side can be entered
    if (std::abs(o.z) <= half || d.z * side >= 0.0) {
        return kMiss;
    }
    const double t = (side - o.z) / d.z;
    const double x = o.x + t * d.x, y = o.y + t * d.y;
    return x * x + y * y <= radius * radius ? t : kMiss;
}

struct TorusValue {
    double distance, slope; // along the ray
    double ring;            // distance from the torus' axis [m]
};

TorusValue torusAlong(const dvec3& p, const dvec3& d, const dvec3& size) noexcept {
    const double ring = std::sqrt(p.x * p.x + p.y * p.y);
    const double u = ring - size.x;
    const double q = std::sqrt(u * u + p.z * p.z);
    const double ringSlope = ring > 0.0 ? (p.x * d.x + p.y * d.y) / ring : 0.0;
    return {q - size.y, q > 0.0 ? (u * ringSlope + p.z * d.z) / q : 1.0, ring};
}

constexpr double kOnSurface = 1e-11; // [m]

// Marches by steps that cannot pass the surface. The distance to a circle of the ring radius rho bends by no
// less than -1/rho along any line, so over a step of at most rho/2 it stays above f + slope h - h^2/rho: the
// first root of that is a safe step. It converges like Newton's and does not crawl along grazing rays as
// steps of f would.
double enterTorus(const dvec3& o, const dvec3& d, const dvec3& size) noexcept {
    const double outer = size.x + size.y;
    const double b = glm::dot(o, d), c = glm::dot(o, o) - outer * outer, discriminant = b * b - c;
    if (discriminant <= 0.0 || (c > 0.0 && b >= 0.0) || torusAlong(o, d, size).distance <= 0.0) {
        return kMiss;
    }
    const double end = -b + std::sqrt(discriminant); // the bounding ball's far side
    double t = c > 0.0 ? c / end : 0.0;
    for (int i = 0; i < 1000 && t <= end; ++i) {
        const auto [f, slope, ring] = torusAlong(o + t * d, d, size);
        if (f < kOnSurface) {
            return t;
        }
        const double root = std::sqrt(slope * slope + 4.0 * f / ring);
        const double step = slope > 0.0 ? 0.5 * ring * (root + slope) : 2.0 * f / (root - slope);
        t += std::max(f, std::min(step, 0.5 * ring));
    }
    return kMiss;
}

} // namespace

std::optional<double> enter(const Solid& solid, const Ray& ray) noexcept {
    const double t = enterFrom(solid, solid.toLocal(ray.origin), ray.direction);
    return t < kMiss ? std::optional<double>(t) : std::nullopt;
}

double enterFrom(const Solid& solid, const dvec3& localOrigin, const dvec3& direction) noexcept {
    const dvec3& o = localOrigin;
    const dvec3 d = solid.localTscene * direction;
    switch (solid.kind) {
    case SolidKind::Sphere:
        return enterRound(o, d, solid.size.x, 3);
    case SolidKind::Box:
        return enterBox(o, d, solid.size);
    case SolidKind::Plane:
        return enterPlane(o, d);
    case SolidKind::Capsule:
        return enterCapsule(o, d, solid.size.x, solid.size.z);
    case SolidKind::Cylinder:
        return enterCylinder(o, d, solid.size.x, solid.size.z);
    case SolidKind::Torus:
        return enterTorus(o, d, solid.size);
    }
    return kMiss;
}

} // namespace fathom
