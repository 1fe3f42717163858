// SPDX-License-Identifier: Apache-2.0
// Test sets for the time budgets: tools that touch a wall of spheres, and the constraint rows of their
// contacts.
#pragma once

#include "engine/contact/nearest_spheres.h"
#include "engine/reference/kkt.h"

#include <array>
#include <string>
#include <vector>

namespace fathom::profile {

// A wavy wall, its grid, a tool, and poses with the tool's deepest leaf `depth` [m] inside the wall.
// Orientations are random, positions are spread over the middle of the wall.
struct TouchRig {
    HostFixtures wall;
    RegionGrid grid;
    Tool tool;
    std::vector<Pose> poses;

    // half: as in wavyWall(), at 1.63 mm spacing. Deterministic.
    TouchRig(int half, uint32_t leaves, size_t poses, double depth);

    // Smallest gap between tool and wall [m] from the grid in float64, at most `within`.
    double smallestGap(const Pose& pose, double within) const;
};

// Compares with all spheres in float64: every leaf has a sphere if one is within `limit`, and it is the
// nearest, both to 1e-6 m. Empty when they agree.
std::string nearestDiffers(const TouchRig& rig, const Pose& pose, double limit,
                           const std::vector<NearestSphere>& found);

// A linearised contact problem as the proxy builds it: unknowns [a; alpha], metric radius 5 cm.
struct ContactProblem {
    static constexpr size_t kRows = 64;
    std::array<double, 36> metric{};
    std::array<double, 6> target{};
    std::vector<double> normals; // kRows x 6
    std::vector<double> offsets;
    std::vector<uint64_t> keys;

    NearestPointProblem view() const { return {6, metric, target, normals, offsets}; }
};

// One problem per pose that has at least 64 rows within 10 mm, from the nearest 64. The hand is 2 mm deeper
// and rotated.
std::vector<ContactProblem> contactProblems(const TouchRig& rig);

} // namespace fathom::profile
