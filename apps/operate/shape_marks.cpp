// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/shape_marks.h"

#include "apps/operate/theme.h"

#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kFullTurn = 6.283185307179586;

} // namespace

void drawSegment(ImDrawList& list, const ViewPort& port, const dvec3& a, const dvec3& b, ImU32 colour,
                 float width) {
    const auto p = port.of(a), q = port.of(b);
    if (p && q) {
        list.AddLine(*p, *q, colour, width);
    }
}

void drawBox(ImDrawList& list, const ViewPort& port, const Shape& shape, ImU32 colour) {
    const dvec3 h = 0.5 * shape.size;
    const auto corner = [&](int c) {
        return shape.baseTshape.apply({c & 1 ? h.x : -h.x, c & 2 ? h.y : -h.y, c & 4 ? h.z : -h.z});
    };
    for (int i = 0; i < 8; ++i) {
        for (int bit : {1, 2, 4}) {
            if ((i & bit) == 0) {
                drawSegment(list, port, corner(i), corner(i | bit), colour, 1.6f);
            }
        }
    }
}

void drawShape(ImDrawList& list, const ViewPort& port, const Shape& shape) {
    const ImU32 colour = shape.isEquality() ? colour::kGuidance : colour::kRegionSoft;
    const auto at = [&](double x, double y, double z) { return shape.baseTshape.apply({x, y, z}); };
    const auto ring = [&](double r, double z, int axis) {
        for (int i = 0; i < 40; ++i) {
            const double a = kFullTurn * i / 40, b = kFullTurn * (i + 1) / 40;
            const auto p = [&](double w) {
                const double c = r * std::cos(w), s = r * std::sin(w);
                return axis == 2 ? at(c, s, z) : axis == 1 ? at(c, z, s) : at(z, c, s);
            };
            drawSegment(list, port, p(a), p(b), colour, 1.6f);
        }
    };
    switch (shape.kind) {
    case ShapeKind::Sphere:
        for (int axis = 0; axis < 3; ++axis) {
            ring(shape.size.x, 0.0, axis);
        }
        break;
    case ShapeKind::Box:
        drawBox(list, port, shape, colour);
        break;
    case ShapeKind::Plane:
        for (double k = -0.2; k <= 0.201; k += 0.1) {
            drawSegment(list, port, at(k, -0.2, 0), at(k, 0.2, 0), colour, 1.2f);
            drawSegment(list, port, at(-0.2, k, 0), at(0.2, k, 0), colour, 1.2f);
        }
        break;
    case ShapeKind::Cylinder:
        ring(shape.size.x, 0.5 * shape.size.y, 2);
        ring(shape.size.x, -0.5 * shape.size.y, 2);
        break;
    case ShapeKind::Line:
    case ShapeKind::Axis:
        drawSegment(list, port, at(0, 0, -0.4), at(0, 0, 0.4), colour, 2.4f);
        break;
    case ShapeKind::None:
        break;
    }
}

} // namespace fathom::operate
