// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/thin.comp and of the rule that applies its decisions, and an oracle for the required
// property: the kept spheres cover the spheres of all points.
#pragma once

#include "engine/reference/spheres.h"

namespace fathom::reference {

// Decision for a 4x4 cell of pixels: thinned as one (corners grow by `whole`), or each of its 2x2 cells
// separately (row-major); < 0 = not thinned.
struct CellThinning {
    double whole = -1.0;
    std::array<double, 4> quarters{-1.0, -1.0, -1.0, -1.0};
    bool unsure = false; // some growth is within 1e-6 m of the budget
};

// Cells of 4x4 pixels, row-major, ceil(width / 4) across. A k x k cell is thinned when its (k+1)^2 points are
// all of one class and the growth that its corner points p_i need stays within scene.errorBudget: for every
// point q with bilinear mean q' = sum l_i p_i, e = |q - q'|, V = sum l_i |p_i - q'|^2 the corners need
// sqrt((R + e)^2 + V).
std::vector<CellThinning> thin(const Scene& scene, int width, int height, std::span<const int> classes,
                               const PointImage& points);

// Growth of every pixel's sphere [m]; -1 = dropped. Kept are all corners of 4x4 cells; corners of 2x2 cells,
// unless all 4x4 cells that contain them are thinned as one; and other pixels, unless their own cell is
// thinned.
std::vector<double> keptGrowth(int width, int height, std::span<const CellThinning> cells);

// Draws points in the union of `all` and tests whether the union of `kept` contains them. Every fourth point
// is on the outer boundary, where a ray from a random centre leaves its last sphere; there dimples show.
// Draws depend only on the seed. Brute force: samples x spheres.
struct Coverage {
    uint32_t samples = 0, holes = 0; // holes: points outside by more than the tolerance
    double worst = 0.0;              // [m] largest distance outside
};
Coverage coverage(std::span<const RegionSphere> all, std::span<const RegionSphere> kept, uint32_t samples,
                  double tolerance, uint64_t seed);

} // namespace fathom::reference
