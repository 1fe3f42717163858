// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/tile_lists.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

struct TangentBounds {
    double lowX = -HUGE_VAL, highX = HUGE_VAL, lowY = -HUGE_VAL, highY = HUGE_VAL;
    double near = 0.0;
};

// Tangents of the planes through the view's origin that touch a sphere, in one axis; false when it reaches
// behind.
bool touching(double across, double z, double radius, double& low, double& high) {
    const double away = std::sqrt(across * across + z * z);
    if (away <= radius) {
        return false;
    }
    const double middle = std::atan2(across, z), half = std::asin(radius / away);
    const double limit = 0.5 * std::acos(-1.0) - 1e-6;
    if (middle - half <= -limit || middle + half >= limit) {
        return false;
    }
    low = std::min(low, std::tan(middle - half));
    high = std::max(high, std::tan(middle + half));
    return true;
}

// Perspective keeps convex hulls (all in front), so the bounds of the hull's spheres bound the solid.
TangentBounds boundsOf(const Solid& solid, const Pose& viewTscene) {
    const HullSpheres hull = hullOf(solid);
    TangentBounds b;
    if (hull.count == 0) {
        return b;
    }
    TangentBounds tight{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL};
    for (uint32_t i = 0; i < hull.count; ++i) {
        const dvec3 c = viewTscene.apply(hull.spheres[i].centre);
        const double r = hull.spheres[i].radius;
        if (!touching(c.x, c.z, r, tight.lowX, tight.highX) ||
            !touching(c.y, c.z, r, tight.lowY, tight.highY)) {
            return b;
        }
        tight.near = std::min(tight.near, c.z - r);
    }
    tight.near = std::max(tight.near, 0.0);
    return tight;
}

// First and last tile of low..high, one spare on each side for rounding.
std::pair<int64_t, int64_t> tileRange(double low, double high, double start, double step, uint32_t count) {
    const double last = static_cast<double>(count) - 1.0;
    const double first = std::clamp(std::floor((low - start) / step - 0.01), 0.0, last + 1.0);
    const double final = std::clamp(std::floor((high - start) / step + 0.01), -1.0, last);
    return {static_cast<int64_t>(first), static_cast<int64_t>(final)};
}

// Over a plane 1 / z is affine in the tangents, so a tile's corners tell its nearest point there. Returns its
// depth, or infinity when the plane's front shows nowhere in the tile.
double nearestOfPlane(const Solid& plane, const Pose& sceneTview, const TangentGrid& grid, int64_t i,
                      int64_t j) {
    const double height = plane.toLocal(sceneTview.position).z;
    double inverse = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        const double x = grid.x0 + grid.stepX * static_cast<double>(i + (corner & 1));
        const double y = grid.y0 + grid.stepY * static_cast<double>(j + (corner >> 1));
        const double down = (plane.localTscene * (sceneTview.rotation * dvec3(x, y, 1.0))).z;
        inverse = std::max(inverse, -down / height);
    }
    return height > 0.0 && inverse > 0.0 ? 0.999999 / inverse : HUGE_VAL;
}

} // namespace

void TileLists::build(const AnalyticScene& scene, const Pose& sceneTview, const TangentGrid& grid) {
    grid_ = grid;
    tiles_.resize(size_t{grid.columns} * grid.rows);
    for (auto& tile : tiles_) {
        tile.clear();
    }
    sights_.clear();
    for (const Solid& solid : scene.solids) {
        const dvec3 towards = solid.position - sceneTview.position;
        const double missSquare = glm::dot(towards, towards) - solid.bound * solid.bound;
        sights_.push_back({towards, missSquare, solid.toLocal(sceneTview.position)});
    }
    const Pose viewTscene = inverse(sceneTview);
    for (uint32_t s = 0; s < scene.solids.size(); ++s) {
        const Solid& solid = scene.solids[s];
        const TangentBounds b = boundsOf(solid, viewTscene);
        const auto [left, right] = tileRange(b.lowX, b.highX, grid.x0, grid.stepX, grid.columns);
        const auto [top, bottom] = tileRange(b.lowY, b.highY, grid.y0, grid.stepY, grid.rows);
        for (int64_t j = top; j <= bottom; ++j) {
            for (int64_t i = left; i <= right; ++i) {
                const bool plane = solid.kind == SolidKind::Plane;
                const double near = plane ? nearestOfPlane(solid, sceneTview, grid, i, j) : b.near;
                if (near < HUGE_VAL) {
                    tiles_[static_cast<size_t>(j) * grid.columns + static_cast<size_t>(i)].push_back(
                        {near, s});
                }
            }
        }
    }
    for (auto& tile : tiles_) {
        std::ranges::stable_sort(tile, {}, &Entry::near);
    }
}

bool TileLists::inside(double x, double y) const noexcept {
    const double i = (x - grid_.x0) / grid_.stepX, j = (y - grid_.y0) / grid_.stepY;
    return i >= 0.0 && j >= 0.0 && i < grid_.columns && j < grid_.rows;
}

std::span<const TileLists::Entry> TileLists::at(double x, double y) const noexcept {
    const auto i = static_cast<size_t>((x - grid_.x0) / grid_.stepX);
    const auto j = static_cast<size_t>((y - grid_.y0) / grid_.stepY);
    return tiles_[j * grid_.columns + i];
}

} // namespace fathom
