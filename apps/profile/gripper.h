// SPDX-License-Identifier: Apache-2.0
// An analytic gripper, so that distances to it are exact, and spheres in its place.
#pragma once

#include "devices/simulated/solid.h"
#include "engine/model/triangle_mesh.h"

#include <vector>

namespace fathom::profile {

// Palm, wrist and two fingers; towards -z, where the wall is.
std::vector<Solid> gripper();

double distanceTo(const std::vector<Solid>& shape, const dvec3& p); // [m] negative inside

// The same as a closed mesh a part, round ones by facets that touch them from outside: at most 0.1 mm larger.
TriangleMesh gripperMesh();

// The finest cubic grid of at most `most` spheres of radius `share` of its edge, wherever the cell's ball
// meets the shape. share 0.866 (half the cell's diagonal) covers the shape wholly; less leaves gaps and
// stands out less.
std::vector<Sphere> coverWith(const std::vector<Solid>& shape, size_t most, double share);

struct Fit {
    double protrusion = 0.0, gap = 0.0; // [m] farthest of the spheres from the shape; of the shape from them
};

// By the points of each sphere that no exact formula bounds: 200 directions, and shape points on a 2 mm grid.
Fit fitOf(const std::vector<Solid>& shape, const std::vector<Sphere>& spheres);

} // namespace fathom::profile
