// SPDX-License-Identifier: Apache-2.0
// What the time budgets name: tools that touch a wall of spheres, and the rows of their contacts.
#pragma once

#include "engine/contact/contact_row.h"
#include "engine/contact/contact_set.h"
#include "engine/contact/nearest_spheres.h"
#include "engine/reference/kkt.h"

#include <array>
#include <string>
#include <vector>

namespace fathom::profile {

// A wavy wall, its grid, a tool, and poses in which the tool's deepest leaf stands `depth` [m] in the wall,
// any way round, all over the wall's middle.
struct TouchRig {
    Fixtures wall;
    RegionGrid grid;
    Tool tool;
    std::vector<Pose> poses;

    // half: as of wavyWall(), at 1.63 mm spacing. The same for equal arguments.
    TouchRig(int half, uint32_t leaves, size_t poses, double depth);

    // By the grid, float64: smallest gap between tool and wall [m], `within` where it is larger.
    double smallestGap(const Pose& pose, double within) const;
};

// Compares with all spheres in float64: the gap to 1e-6 m, and whether there is one, unless that hangs on
// less. Empty when they agree.
std::string nearestDiffers(const TouchRig& rig, const Pose& pose, double limit,
                           const std::vector<NearestSphere>& found);

// A linearisation as the proxy makes it: unknowns [a; alpha], the metric's radius 5 cm.
struct ContactProblem {
    static constexpr size_t kRows = 64;
    std::array<double, 36> metric{};
    std::array<double, 6> target{};
    std::vector<double> normals; // kRows x 6
    std::vector<double> offsets;
    std::vector<uint64_t> keys;

    NearestPointProblem view() const { return {6, metric, target, normals, offsets}; }
};

// One a pose that has so many rows within 10 mm, the 64 nearest of them; the hand is 2 mm deeper and turned.
std::vector<ContactProblem> contactProblems(const TouchRig& rig);

} // namespace fathom::profile
