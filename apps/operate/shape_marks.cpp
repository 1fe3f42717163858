// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/shape_marks.h"

#include "apps/operate/theme.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kPlaneHalf = 0.2; // [m] shown part of a plane

// Points on a shape whose hull is its outline in any view (own frame).
std::vector<dvec3> surfacePoints(const Shape& shape) {
    std::vector<dvec3> points;
    constexpr int kAround = 32, kUp = 16;
    const auto ring = [&](double r, double z) {
        for (int i = 0; i < kAround; ++i) {
            const double a = kTurn * i / kAround;
            points.emplace_back(r * std::cos(a), r * std::sin(a), z);
        }
    };
    const dvec3 h = shape.kind == ShapeKind::Plane ? dvec3(kPlaneHalf, kPlaneHalf, 0.0) : 0.5 * shape.size;
    switch (shape.kind) {
    case ShapeKind::Sphere:
        for (int k = 0; k <= kUp; ++k) {
            const double a = 0.5 * kTurn * k / kUp;
            ring(shape.size.x * std::sin(a), shape.size.x * std::cos(a));
        }
        break;
    case ShapeKind::Cylinder:
        ring(shape.size.x, 0.5 * shape.size.y);
        ring(shape.size.x, -0.5 * shape.size.y);
        break;
    default:
        for (int c = 0; c < 8; ++c) {
            points.emplace_back(c & 1 ? h.x : -h.x, c & 2 ? h.y : -h.y, c & 4 ? h.z : -h.z);
        }
    }
    return points;
}

// Corners of the convex hull, by Andrew's monotone chain.
std::vector<ImVec2> hullOf(std::vector<ImVec2> p) {
    std::sort(p.begin(), p.end(), [](ImVec2 a, ImVec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<ImVec2> hull;
    const auto chain = [&](auto begin, auto end) {
        const size_t first = hull.size();
        for (auto at = begin; at != end; ++at) {
            const auto turns = [&] {
                const ImVec2 a = hull[hull.size() - 2], b = hull.back();
                return (b.x - a.x) * (at->y - a.y) - (b.y - a.y) * (at->x - a.x) > 1e-3f;
            };
            while (hull.size() >= first + 2 && !turns()) {
                hull.pop_back();
            }
            hull.push_back(*at);
        }
        hull.pop_back(); // the other chain begins with it
    };
    chain(p.begin(), p.end());
    chain(p.rbegin(), p.rend());
    return hull;
}

// Where the line x + y = c crosses a convex outline.
std::vector<ImVec2> crossings(const std::vector<ImVec2>& hull, float c) {
    std::vector<ImVec2> found;
    for (size_t i = 0; i < hull.size(); ++i) {
        const ImVec2 a = hull[i], b = hull[(i + 1) % hull.size()];
        const float da = a.x + a.y - c, db = b.x + b.y - c;
        if ((da < 0.0f) != (db < 0.0f)) {
            const float s = da / (da - db);
            found.push_back({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)});
        }
    }
    return found;
}

// Like the regions of points in the camera's image (camera_view_image.cpp).
void fillHatched(ImDrawList& list, const std::vector<ImVec2>& hull) {
    constexpr float kApart = 12.0f, kMaxLines = 400.0f; // [pixels]
    list.AddConvexPolyFilled(hull.data(), static_cast<int>(hull.size()), IM_COL32(237, 41, 36, 62));
    float low = 1e9f, high = -1e9f;
    for (const ImVec2& p : hull) {
        low = std::min(low, p.x + p.y);
        high = std::max(high, p.x + p.y);
    }
    const float apart = std::max(kApart, (high - low) / kMaxLines);
    for (float c = std::ceil(low / apart) * apart; c < high; c += apart) {
        const std::vector<ImVec2> ends = crossings(hull, c);
        if (ends.size() == 2) {
            list.AddLine(ends[0], ends[1], IM_COL32(237, 41, 36, 128), 2.0f);
        }
    }
}

void outlineHull(ImDrawList& list, const std::vector<ImVec2>& hull, ImU32 colour) {
    const auto count = static_cast<int>(hull.size());
    list.AddPolyline(hull.data(), count, colour::kShade, ImDrawFlags_Closed, 5.0f);
    list.AddPolyline(hull.data(), count, colour, ImDrawFlags_Closed, 3.0f);
}

// Dashes that continue round corners.
void dashHull(ImDrawList& list, const std::vector<ImVec2>& hull, ImU32 colour) {
    constexpr float kDash = 7.0f; // [pixels]
    float along = 0.0f;
    for (size_t i = 0; i < hull.size(); ++i) {
        const ImVec2 a = hull[i], b = hull[(i + 1) % hull.size()];
        const float length = std::hypot(b.x - a.x, b.y - a.y);
        const auto at = [&](float s) {
            return ImVec2(a.x + (b.x - a.x) * s / length, a.y + (b.y - a.y) * s / length);
        };
        for (float s = 0.0f; s < length;) {
            const float next = std::min(length, s + kDash - std::fmod(along + s, kDash) + 1e-3f);
            if (static_cast<int>((along + s) / kDash) % 2 == 0) {
                list.AddLine(at(s), at(next), colour::kShade, 5.0f);
                list.AddLine(at(s), at(next), colour, 3.0f);
            }
            s = next;
        }
        along += length;
    }
}

// The outline of a solid shape; empty when a part of it is behind the eye.
std::vector<ImVec2> hullOf(const ViewPort& port, const Shape& shape) {
    std::vector<ImVec2> points;
    for (const dvec3& p : surfacePoints(shape)) {
        const auto at = port.of(shape.baseTshape.apply(p));
        if (!at) {
            return {};
        }
        points.push_back(*at);
    }
    return hullOf(std::move(points));
}

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

namespace {

void drawEdges(ImDrawList& list, const ViewPort& port, const Shape& shape, ImU32 colour) {
    const auto at = [&](double x, double y, double z) { return shape.baseTshape.apply({x, y, z}); };
    const auto ring = [&](double r, double z, int axis) {
        for (int i = 0; i < 40; ++i) {
            const double a = kTurn * i / 40, b = kTurn * (i + 1) / 40;
            const auto p = [&](double w) {
                const double c = r * std::cos(w), s = r * std::sin(w);
                return axis == 2 ? at(c, s, z) : axis == 1 ? at(c, z, s) : at(z, c, s);
            };
            drawSegment(list, port, p(a), p(b), colour, 1.2f);
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
        for (double k = -kPlaneHalf; k <= kPlaneHalf + 1e-3; k += 0.1) {
            drawSegment(list, port, at(k, -kPlaneHalf, 0), at(k, kPlaneHalf, 0), colour, 1.2f);
            drawSegment(list, port, at(-kPlaneHalf, k, 0), at(kPlaneHalf, k, 0), colour, 1.2f);
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

} // namespace

void drawShape(ImDrawList& list, const ViewPort& port, const Shape& shape, ShapeLook look) {
    const bool ghost = look == ShapeLook::Ghost;
    const ImU32 soft = shape.isEquality() ? colour::kGuidance : colour::kRegionSoft;
    const auto hull = shape.isEquality() ? std::vector<ImVec2>() : hullOf(port, shape);
    if (hull.size() > 2 && ghost) {
        dashHull(list, hull, colour::kPicked);
    } else if (hull.size() > 2) {
        if (!shape.keepIn) {
            fillHatched(list, hull);
        }
        outlineHull(list, hull, colour::kRegion);
    }
    drawEdges(list, port, shape, ghost ? colour::kPicked : soft);
}

} // namespace fathom::operate
