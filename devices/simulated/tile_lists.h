// SPDX-License-Identifier: Apache-2.0
// Which solids can show in which tile of a pinhole view: what makes a ray test a handful of solids and not
// all.
#pragma once

#include "devices/simulated/analytic_scene.h"

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

namespace fathom {

// Tiles in the view's tangent plane (x/z, y/z): tile (i, j) spans x0 + i * step .. x0 + (i + 1) * step.
struct TangentGrid {
    double x0 = 0.0, y0 = 0.0;
    double stepX = 1.0, stepY = 1.0;
    uint32_t columns = 1, rows = 1;
};

// Conservative: a ray from the view's origin inside a tile can only enter solids of that tile's list. Rays
// outside the grid are the caller's to refuse (inside() below).
class TileLists {
public:
    // Solids in a tile, nearest bound first.
    struct Entry {
        double near;    // [m] along the view's z; nothing of the solid in this tile is nearer
        uint32_t solid; // index into the scene's solids
    };
    // A solid and the ball that encloses it, as the view's origin sees them.
    struct Sight {
        dvec3 towards;     // [m] from the view's origin to the solid's position, scene axes
        double missSquare; // [m^2] |towards|^2 - bound^2: a ray whose share along `towards` is smaller misses
        dvec3 localOrigin; // [m] the view's origin in the solid's frame
    };

    void build(const AnalyticScene& scene, const Pose& sceneTview, const TangentGrid& grid);

    bool inside(double x, double y) const noexcept; // tangents of a ray
    std::span<const Entry> at(double x, double y) const noexcept;

    // Where a ray from the view's origin enters a solid [m], infinity when it does not; unit direction, scene
    // axes. Rays that miss the solid's ball cost a dot product.
    double enterSolid(const AnalyticScene& scene, uint32_t solid, const dvec3& direction) const noexcept {
        const Sight& sight = sights_[solid];
        const double along = glm::dot(sight.towards, direction);
        if (along * along < sight.missSquare) {
            return HUGE_VAL;
        }
        return enterFrom(scene.solids[solid], sight.localOrigin, direction);
    }

private:
    std::vector<std::vector<Entry>> tiles_; // row-major; kept between builds for their memory
    std::vector<Sight> sights_;             // one per solid
    TangentGrid grid_;
};

} // namespace fathom
