// SPDX-License-Identifier: Apache-2.0
// The plain ways to put spheres round a mesh, to compare with: cells of a grid, and of an octree (Hubbard
// 1996).
#pragma once

#include "engine/model/mesh_distance.h"
#include "engine/types/sphere_tree.h"

#include <vector>

namespace fathom::reference {

// One sphere round each cube of the finest grid over the mesh's box whose occupied cubes are at most `most`.
// A cube is occupied when a dense sample of the surface lies in it or its middle is inside.
std::vector<Sphere> gridCover(const TriangleMesh& mesh, const MeshDistance& distance, size_t most);

// Largest cubes split first, while at most `most` are occupied. A cube that the surface crosses gets the
// smaller of its own sphere and one about the box of the samples in it.
std::vector<Sphere> octreeCover(const TriangleMesh& mesh, const MeshDistance& distance, size_t most);

} // namespace fathom::reference
