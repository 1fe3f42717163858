// SPDX-License-Identifier: Apache-2.0
// Twin of the guidance pose (paper IV.B.2): plane test, normal, target; and of a class's options largest_part
// and trim. Eigenvectors come from Eigen.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/reference/moments.h"

namespace fathom::reference {

// Pose of the points of one guidance class. camera: base frame [m]. GuidancePose::fixture is left at 0.
GuidancePose guidance(std::span<const dvec3> points, const FixtureClass& fixture, const dvec3& camera);

// Marks the largest 8-connected part of the pixels with class bit c and a point. Depths of neighbours differ
// by at most edge (relative to either; 0 = any). Of equal parts, takes the first in row-major order.
std::vector<uint8_t> largestPart(int width, int height, std::span<const uint32_t> masks,
                                 const PointImage& points, size_t c, double edge);

// Drops the floor(share x count) points farthest from the mean of all.
std::vector<dvec3> trimmed(std::vector<dvec3> points, double share);

} // namespace fathom::reference
