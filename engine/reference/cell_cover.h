// SPDX-License-Identifier: Apache-2.0
// Simple sphere covers of a mesh, as a baseline: cells of a grid, and of an octree (Hubbard 1996).
#pragma once

#include "engine/model/mesh_distance.h"
#include "engine/types/sphere_tree.h"

#include <vector>

namespace fathom::reference {

// One sphere around each occupied cube of the finest grid over the mesh's box with at most `most` occupied
// cubes. A cube is occupied when it contains a dense surface sample or its centre is inside the mesh.
std::vector<Sphere> gridCover(const TriangleMesh& mesh, const MeshDistance& distance, size_t most);

// Splits the largest cubes first, while at most `most` are occupied. A cube that the surface crosses gets the
// smaller of its own sphere and that of the box of its samples.
std::vector<Sphere> octreeCover(const TriangleMesh& mesh, const MeshDistance& distance, size_t most);

} // namespace fathom::reference
