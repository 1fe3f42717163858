// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr double kNoDirection = 1e-12; // [m] or [1]: shorter vectors have no direction

dvec3 axisVector(int axis, double sign) {
    dvec3 v{0.0};
    v[axis] = sign;
    return v;
}

double signOf(double v) {
    return v < 0.0 ? -1.0 : 1.0;
}

dvec3 radialDirection(const dvec3& p) {
    const dvec3 radial(p.x, p.y, 0.0);
    const double length = glm::length(radial);
    return length > kNoDirection ? radial / length : dvec3(1.0, 0.0, 0.0);
}

// Signed distance and gradient in the shape's frame, negative inside.
SideGap sphereDistance(double radius, const dvec3& p) {
    const double length = glm::length(p);
    return {length - radius, length > kNoDirection ? p / length : dvec3(0.0, 0.0, 1.0)};
}

SideGap boxDistance(const dvec3& half, const dvec3& p) {
    const dvec3 q = glm::abs(p) - half;
    const dvec3 out = glm::max(q, dvec3(0.0));
    const double length = glm::length(out);
    if (length > 0.0) {
        return {length, dvec3(signOf(p.x), signOf(p.y), signOf(p.z)) * out / length};
    }
    const int axis = q.x >= q.y && q.x >= q.z ? 0 : (q.y >= q.z ? 1 : 2);
    return {q[axis], axisVector(axis, signOf(p[axis]))};
}

SideGap cylinderDistance(double radius, double halfLength, const dvec3& p) {
    const dvec3 radial = radialDirection(p);
    const dvec3 along(0.0, 0.0, signOf(p.z));
    const double side = std::hypot(p.x, p.y) - radius;
    const double cap = std::abs(p.z) - halfLength;
    if (side > 0.0 && cap > 0.0) { // nearest to the rim
        const double length = std::hypot(side, cap);
        return {length, (side * radial + cap * along) / length};
    }
    return side >= cap ? SideGap{side, radial} : SideGap{cap, along};
}

SideGap distanceTo(const Shape& shape, const dvec3& p) {
    switch (shape.kind) {
    case ShapeKind::Sphere:
        return sphereDistance(shape.size.x, p);
    case ShapeKind::Box:
        return boxDistance(0.5 * shape.size, p);
    case ShapeKind::Cylinder:
        return cylinderDistance(shape.size.x, 0.5 * shape.size.y, p);
    case ShapeKind::Plane:
    default:
        return {p.z, dvec3(0.0, 0.0, 1.0)};
    }
}

dvec3 toShape(const Shape& shape, const dvec3& point) {
    return glm::conjugate(shape.baseTshape.rotation) * (point - shape.baseTshape.position);
}

SideGap cap(double halfLength, double sign, const dvec3& p, double radius) {
    return {halfLength - sign * p.z - radius, dvec3(0.0, 0.0, -sign)};
}

// Rotation vector of the shortest rotation from `from` to `to` (unit vectors).
dvec3 turnOnto(const dvec3& from, const dvec3& to) {
    const dvec3 cross = glm::cross(from, to);
    const double sine = glm::length(cross);
    const double angle = std::atan2(sine, glm::dot(from, to));
    if (sine > kNoDirection) {
        return cross * (angle / sine);
    }
    const dvec3 other = std::abs(to.x) < 0.5 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
    return angle *
           glm::normalize(glm::cross(to, other)); // opposite vectors: any axis; equal vectors: angle 0
}

} // namespace

std::vector<Shape> shapesOf(const Scene& scene) {
    std::vector<Shape> shapes;
    for (size_t i = 0; i < scene.fixtures.size(); ++i) {
        const FixtureClass& row = scene.fixtures[i];
        if (!row.isPoints()) {
            shapes.push_back({row.shape, row.keepIn, row.size, row.baseTshape, static_cast<uint32_t>(i)});
            shapes.back().baseTshape.rotation = glm::normalize(row.baseTshape.rotation);
        }
    }
    return shapes;
}

SideGap gapTo(const Shape& shape, const dvec3& centre, double radius) noexcept {
    SideGap side = distanceTo(shape, toShape(shape, centre));
    if (shape.keepIn) {
        side = {-side.gap, -side.normal};
    }
    return {side.gap - radius, shape.baseTshape.rotation * side.normal};
}

double edgeDistance(const Shape& shape, const dvec3& centre) noexcept {
    const dvec3 p = toShape(shape, centre);
    if (!shape.keepIn && shape.kind == ShapeKind::Box) {
        dvec3 left = 0.5 * shape.size - glm::abs(p); // to the faces; the nearest one's is no way along it
        std::sort(&left[0], &left[0] + 3);
        return std::max(0.0, left[1]);
    }
    if (!shape.keepIn && shape.kind == ShapeKind::Cylinder) {
        return std::max({0.0, shape.size.x - std::hypot(p.x, p.y), 0.5 * shape.size.y - std::abs(p.z)});
    }
    return std::numeric_limits<double>::infinity();
}

size_t sidesOf(const Shape& shape, const dvec3& centre, double radius,
               std::array<SideGap, kMaxSides>& sides) noexcept {
    size_t count = 0;
    const dvec3 p = toShape(shape, centre);
    if (shape.keepIn && shape.kind == ShapeKind::Box) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const double sign : {-1.0, 1.0}) {
                sides[count++] = {0.5 * shape.size[axis] - sign * p[axis] - radius, axisVector(axis, -sign)};
            }
        }
    } else if (shape.keepIn && shape.kind == ShapeKind::Cylinder) {
        sides[count++] = {shape.size.x - std::hypot(p.x, p.y) - radius, -radialDirection(p)};
        sides[count++] = cap(0.5 * shape.size.y, -1.0, p, radius);
        sides[count++] = cap(0.5 * shape.size.y, 1.0, p, radius);
    } else {
        sides[0] = gapTo(shape, centre, radius);
        return 1;
    }
    for (size_t i = 0; i < count; ++i) {
        sides[i].normal = shape.baseTshape.rotation * sides[i].normal;
    }
    return count;
}

size_t equalitiesOf(const Shape& shape, const Pose& baseTtool,
                    std::array<Equality, kMaxEqualities>& equalities) noexcept {
    const dquat& q = shape.baseTshape.rotation;
    const std::array<dvec3, 2> across{q * dvec3(1.0, 0.0, 0.0), q * dvec3(0.0, 1.0, 0.0)};
    const dvec3 offset = baseTtool.position - shape.baseTshape.position;
    size_t count = 0;
    for (const dvec3& u : across) {
        equalities[count++] = {u, dvec3(0.0), glm::dot(u, offset)};
    }
    if (shape.kind == ShapeKind::Axis) {
        const dvec3 turn = turnOnto(baseTtool.rotation * dvec3(0.0, 0.0, 1.0), q * dvec3(0.0, 0.0, 1.0));
        for (const dvec3& u : across) {
            equalities[count++] = {dvec3(0.0), u, -glm::dot(u, turn)};
        }
    }
    return count;
}

} // namespace fathom
