// SPDX-License-Identifier: Apache-2.0
// From the moments of a guidance class to its pose (paper IV.B.2): mean, plane, normal, target. Float64, pure
// functions.
#pragma once

#include "engine/contact/fixtures.h"
#include "engine/scene/scene.h"

#include <array>
#include <span>
#include <vector>

namespace fathom::cloud {

// Moments of a set of points about their mean: sums of products xx xy xz yy yz zz [m^2].
struct Moments {
    double count = 0.0;
    dvec3 mean{0.0}; // [m] axes of the points
    std::array<double, 6> products{};
};
Moments merge(const Moments& a, const Moments& b) noexcept;
// Pairwise in fixed order: neighbours first, then pairs of pairs. Empty input gives count 0.
Moments mergeAll(std::vector<Moments> parts);
// Of points given one by one, in two passes, the mean about their first.
Moments momentsOf(std::span<const dvec3> points);

// Eigenvalues, largest first, and unit eigenvectors of a symmetric 3x3 matrix (xx xy xz yy yz zz) by Jacobi
// rotations.
struct Eigen3 {
    dvec3 values;
    std::array<dvec3, 3> vectors;
};
Eigen3 symmetricEigen(const std::array<double, 6>& m) noexcept;

// moments.mean in the base frame [m]. Planar when sqrt(l3) <= max(3 mm, 0.1 sqrt(l2)) and sqrt(l2) >= 5 mm
// (l: eigenvalues of the covariance): normal towards the camera, roll from the long axis when l1 > 2 l2, its
// sign the one nearer to the scene's own x axis. Otherwise the scene's orientation, stand-off towards the
// camera.
GuidancePose guidancePose(const Moments& moments, const FixtureClass& fixture, uint32_t row,
                          const dvec3& camera);

} // namespace fathom::cloud
