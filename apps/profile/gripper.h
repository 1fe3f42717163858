// SPDX-License-Identifier: Apache-2.0
// An analytic gripper with exact distances, and sphere sets that approximate it.
#pragma once

#include "devices/simulated/solid.h"
#include "engine/model/triangle_mesh.h"

#include <vector>

namespace fathom::profile {

// Palm, wrist and two fingers that point along -z, towards the wall.
std::vector<Solid> gripper();

double distanceTo(const std::vector<Solid>& shape, const dvec3& p); // [m] negative inside

// The same shape with one closed mesh per part. Facets touch round parts from outside, at most 0.1 mm larger.
TriangleMesh gripperMesh();

// Spheres on the finest cubic grid that needs at most `most` of them, in every cell whose ball meets the
// shape. The radius is `share` of the cell's edge: 0.866 (half the diagonal) covers the whole shape; less
// leaves gaps but protrudes less.
std::vector<Sphere> coverWith(const std::vector<Solid>& shape, size_t most, double share);

struct Fit {
    double protrusion = 0.0, gap = 0.0; // [m] largest, spheres beyond shape; shape beyond spheres
};

// Measured by sampling: 200 directions per sphere, and points of the shape on a 2 mm grid.
Fit fitOf(const std::vector<Solid>& shape, const std::vector<Sphere>& spheres);

} // namespace fathom::profile
