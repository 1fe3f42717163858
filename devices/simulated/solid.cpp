// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/solid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace fathom {

namespace {

// Rotation with rows = local axes in the scene, local z along `axis`.
glm::dmat3 axesAlong(const dvec3& axis) {
    const dvec3 z = glm::normalize(axis);
    const dvec3 other = std::abs(z.x) < 0.9 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
    const dvec3 x = glm::normalize(glm::cross(other, z));
    return glm::transpose(glm::dmat3(x, glm::cross(z, x), z));
}

// Rounding must never shave the ball below the solid.
double slightlyOver(double radius) {
    return radius * (1.0 + 1e-9) + 1e-12;
}

Solid between(SolidKind kind, const dvec3& a, const dvec3& b, double radius, const Paint& paint) {
    const double half = 0.5 * glm::length(b - a);
    const double bound = kind == SolidKind::Capsule ? radius + half : std::hypot(radius, half);
    return {kind, 0.5 * (a + b), axesAlong(b - a), dvec3(radius, 0.0, half), slightlyOver(bound), paint, 0};
}

double hypot2(double a, double b) noexcept {
    return std::sqrt(a * a + b * b);
}

// Distance to the set |u| <= a, |v| <= b from (u, v) given as excess over the bounds.
double outsideOf(double u, double v) noexcept {
    return hypot2(std::max(u, 0.0), std::max(v, 0.0)) + std::min(std::max(u, v), 0.0);
}

double boxDistance(const dvec3& p, const dvec3& half) noexcept {
    const dvec3 q = glm::abs(p) - half;
    const double outside = glm::length(glm::max(q, dvec3(0.0)));
    return outside + std::min(std::max(q.x, std::max(q.y, q.z)), 0.0);
}

dvec3 onAxis(const dvec3& p, double half) noexcept {
    return {0.0, 0.0, glm::clamp(p.z, -half, half)};
}

// Point of the torus' middle circle nearest p.
dvec3 onRim(const dvec3& p, double rim) noexcept {
    const double d = hypot2(p.x, p.y);
    return d > 0.0 ? dvec3(p.x * rim / d, p.y * rim / d, 0.0) : dvec3(rim, 0.0, 0.0);
}

dvec3 boxNormal(const dvec3& p, const dvec3& half) noexcept {
    const dvec3 q = glm::abs(p) - half;
    const int axis = q.x >= q.y ? (q.x >= q.z ? 0 : 2) : (q.y >= q.z ? 1 : 2);
    dvec3 n(0.0);
    n[axis] = p[axis] < 0.0 ? -1.0 : 1.0;
    return n;
}

dvec3 cylinderNormal(const dvec3& p, const dvec3& size) noexcept {
    if (std::abs(p.z) - size.z > hypot2(p.x, p.y) - size.x) {
        return {0.0, 0.0, p.z < 0.0 ? -1.0 : 1.0};
    }
    return glm::normalize(dvec3(p.x, p.y, 0.0));
}

dvec3 localNormal(const Solid& solid, const dvec3& p) noexcept {
    switch (solid.kind) {
    case SolidKind::Sphere:
        return glm::normalize(p);
    case SolidKind::Box:
        return boxNormal(p, solid.size);
    case SolidKind::Plane:
        return {0.0, 0.0, 1.0};
    case SolidKind::Capsule:
        return glm::normalize(p - onAxis(p, solid.size.z));
    case SolidKind::Cylinder:
        return cylinderNormal(p, solid.size);
    case SolidKind::Torus:
        return glm::normalize(p - onRim(p, solid.size.x));
    }
    return {0.0, 0.0, 1.0};
}

} // namespace

Solid sphereAt(const dvec3& centre, double radius, const Paint& paint) {
    return {
        SolidKind::Sphere, centre, glm::dmat3(1.0), dvec3(radius, 0.0, 0.0), slightlyOver(radius), paint, 0};
}

Solid boxAt(const Pose& sceneTbox, const dvec3& halfEdges, const Paint& paint) {
    const glm::dmat3 rotation = glm::transpose(glm::mat3_cast(sceneTbox.rotation));
    return {SolidKind::Box,
            sceneTbox.position,
            rotation,
            halfEdges,
            slightlyOver(glm::length(halfEdges)),
            paint,
            0};
}

Solid planeThrough(const dvec3& point, const dvec3& outwardNormal, const Paint& paint) {
    return {SolidKind::Plane, point, axesAlong(outwardNormal), dvec3(0.0), HUGE_VAL, paint, 0};
}

Solid capsuleBetween(const dvec3& a, const dvec3& b, double radius, const Paint& paint) {
    return between(SolidKind::Capsule, a, b, radius, paint);
}

Solid cylinderBetween(const dvec3& a, const dvec3& b, double radius, const Paint& paint) {
    return between(SolidKind::Cylinder, a, b, radius, paint);
}

Solid torusAt(const dvec3& centre, const dvec3& axis, double rim, double tube, const Paint& paint) {
    return {
        SolidKind::Torus, centre, axesAlong(axis), dvec3(rim, tube, 0.0), slightlyOver(rim + tube), paint, 0};
}

double signedDistance(const Solid& solid, const dvec3& scenePoint) noexcept {
    const dvec3 p = solid.toLocal(scenePoint);
    switch (solid.kind) {
    case SolidKind::Sphere:
        return glm::length(p) - solid.size.x;
    case SolidKind::Box:
        return boxDistance(p, solid.size);
    case SolidKind::Plane:
        return p.z;
    case SolidKind::Capsule:
        return glm::length(p - onAxis(p, solid.size.z)) - solid.size.x;
    case SolidKind::Cylinder:
        return outsideOf(hypot2(p.x, p.y) - solid.size.x, std::abs(p.z) - solid.size.z);
    case SolidKind::Torus:
        return hypot2(hypot2(p.x, p.y) - solid.size.x, p.z) - solid.size.y;
    }
    return 0.0;
}

dvec3 surfaceNormal(const Solid& solid, const dvec3& scenePoint) noexcept {
    // v * M is transpose(M) * v: back from local to scene axes.
    return localNormal(solid, solid.toLocal(scenePoint)) * solid.localTscene;
}

HullSpheres hullOf(const Solid& solid) {
    HullSpheres hull;
    const auto add = [&](const dvec3& local, double radius) {
        hull.spheres[hull.count++] = {solid.position + local * solid.localTscene, radius};
    };
    switch (solid.kind) {
    case SolidKind::Sphere:
        add(dvec3(0.0), solid.size.x);
        break;
    case SolidKind::Box:
        for (int corner = 0; corner < 8; ++corner) {
            add(solid.size * dvec3(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0),
                0.0);
        }
        break;
    case SolidKind::Plane:
        break;
    case SolidKind::Capsule:
    case SolidKind::Cylinder:
        add({0.0, 0.0, -solid.size.z}, solid.size.x);
        add({0.0, 0.0, solid.size.z}, solid.size.x);
        break;
    case SolidKind::Torus:
        add(dvec3(0.0), solid.size.x + solid.size.y);
        break;
    }
    return hull;
}

} // namespace fathom
