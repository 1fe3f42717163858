// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/thin.comp and of the rule that reads its decisions, and an oracle for the property that
// matters: the spheres that are kept cover all that every point's sphere would.
#pragma once

#include "engine/reference/spheres.h"

namespace fathom::reference {

// What becomes of a 4x4 cell of pixels: thinned as one (corners grow by whole), or each of its 2x2 cells by
// itself (row-major); < 0 = not thinned.
struct CellThinning {
    double whole = -1.0;
    std::array<double, 4> quarters{-1.0, -1.0, -1.0, -1.0};
    bool unsure = false; // some growth lies within 1e-6 m of the budget
};

// Cells of 4x4 pixels, row-major, ceil(width / 4) across. A k x k cell is thinned when its (k+1)^2 points are
// all of one class and the growth that its corner points p_i need stays within scene.errorBudget: for every
// point q with bilinear mean q' = sum l_i p_i, e = |q - q'|, V = sum l_i |p_i - q'|^2 the corners need
// sqrt((R + e)^2 + V).
std::vector<CellThinning> thin(const Scene& scene, int width, int height, std::span<const int> classes,
                               const PointImage& points);

// What every pixel's sphere grows by; -1 = left out. Kept are: every corner of a 4x4 cell; a corner of a 2x2
// cell unless all 4x4 cells that contain it are thinned as one; any other pixel unless the cell that owns it
// is thinned.
std::vector<double> keptGrowth(int width, int height, std::span<const CellThinning> cells);

// Draws points in the union of `all` and looks for each in the union of `kept`. Every fourth lies on the
// outer boundary of the union, where a dimple shows: where a ray from a random centre leaves the last sphere
// on its way. The draws depend on the seed alone. Brute force: samples x spheres.
struct Coverage {
    uint32_t samples = 0, holes = 0; // holes: outside by more than tolerance
    double worst = 0.0;              // [m] farthest outside
};
Coverage coverage(std::span<const RegionSphere> all, std::span<const RegionSphere> kept, uint32_t samples,
                  double tolerance, uint64_t seed);

} // namespace fathom::reference
