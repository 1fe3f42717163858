// SPDX-License-Identifier: Apache-2.0
// Placed shapes: exact signed distance of a tool leaf to each shape, and the constraints of
// lines and axes.
#pragma once

#include "engine/scene/scene.h"

#include <array>
#include <vector>

namespace fathom {

// In the shape's own frame: sphere about the origin, size.x = radius. Box about the origin, size = edge
// lengths. Plane: the half-space z <= 0. Cylinder about the origin along z, size.x = radius, size.y = length.
// These are solids: forbidden keeps the tool's leaves outside, keep_in inside. Line: the tool's centre stays
// on the infinite line through the origin along z. Axis: also keeps the tool's +z along the line's +z.
struct Shape {
    ShapeKind kind = ShapeKind::None;
    bool keepIn = false;
    dvec3 size{0.0}; // [m]
    Pose baseTshape;
    uint32_t fixture = 0; // index into Scene::fixtures

    bool isRound() const { return kind == ShapeKind::Sphere || kind == ShapeKind::Cylinder; }
    bool isEquality() const { return kind == ShapeKind::Line || kind == ShapeKind::Axis; }
};

// Every placed shape of a scene, in file order.
std::vector<Shape> shapesOf(const Scene& scene);

// One side of a shape relative to a tool leaf.
struct SideGap {
    double gap = 0.0;            // [m] to the leaf's surface; negative = depth
    dvec3 normal{0.0, 0.0, 1.0}; // unit, base axes, in the direction of growing gap
};

// Half-spaces of one shape: the faces of a box that keeps the tool inside.
inline constexpr size_t kMaxSides = 6;

// Exact gap of a leaf (centre in the base frame [m], radius [m]) to the whole shape. Not for equalities.
SideGap gapTo(const Shape& shape, const dvec3& centre, double radius) noexcept;

// [m] from a leaf's centre, along the flat face of a forbidden shape that it is nearest to, to the face's
// nearest edge; 0 beyond it. Infinite where there is no edge.
double edgeDistance(const Shape& shape, const dvec3& centre) noexcept;

// Writes the half-spaces that keep the leaf on the allowed side and returns their number: one for a forbidden
// shape (convex, so the tangent plane at the nearest point is safe), one per face for keep_in.
size_t sidesOf(const Shape& shape, const dvec3& centre, double radius,
               std::array<SideGap, kMaxSides>& sides) noexcept;

// The tool's next motion [a; alpha] should satisfy linear . a + angular . alpha = -error.
struct Equality {
    dvec3 linear{0.0}, angular{0.0}; // base axes, unit or zero
    double error = 0.0;              // [m] or [rad]
};

// Rows of one line or axis.
inline constexpr size_t kMaxEqualities = 4;

// Writes two rows for a line, plus two of rotation for an axis. Returns their number.
size_t equalitiesOf(const Shape& shape, const Pose& baseTtool,
                    std::array<Equality, kMaxEqualities>& equalities) noexcept;

} // namespace fathom
