// SPDX-License-Identifier: Apache-2.0
// Computes the pose of a guidance class from its moments (paper IV.B.2): mean, plane, normal, target. Pure
// functions in float64.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/scene/scene.h"

#include <array>
#include <span>
#include <vector>

namespace fathom::cloud {

// Moments of a set of points about their mean: sums of products xx xy xz yy yz zz [m^2].
struct Moments {
    double count = 0.0;
    dvec3 mean{0.0}; // [m] in the frame of the points
    std::array<double, 6> products{};
};
Moments merge(const Moments& a, const Moments& b) noexcept;
// Merges pairwise in a fixed order: neighbours first, then pairs of pairs. Empty input gives count 0.
Moments mergeAll(std::vector<Moments> parts);
// Moments of points, in two passes, relative to the first point.
Moments momentsOf(std::span<const dvec3> points);

// Eigenvalues, largest first, and unit eigenvectors of a symmetric 3x3 matrix (xx xy xz yy yz zz) by Jacobi
// rotations.
struct Eigen3 {
    dvec3 values;
    std::array<dvec3, 3> vectors;
};
Eigen3 symmetricEigen(const std::array<double, 6>& m) noexcept;

// moments.mean is in the base frame [m]. With l1 >= l2 >= l3 the eigenvalues of the covariance, the points
// are planar when sqrt(l3) <= max(3 mm, 0.1 sqrt(l2)) and sqrt(l2) >= 5 mm. Then the normal points towards
// the camera. If l1 > 2 l2, the long axis gives the roll, with the sign nearer to the scene's x axis. If not
// planar: the scene's orientation, with the stand-off towards the camera.
GuidancePose guidancePose(const Moments& moments, const FixtureClass& fixture, uint32_t row,
                          const dvec3& camera);

} // namespace fathom::cloud
