// SPDX-License-Identifier: Apache-2.0
// Covers a mesh with few spheres that protrude as little as possible: greedy set cover of the surface
// by inner spheres grown by the allowed protrusion, then each sphere fitted to its share. The surface is cut
// into triangles small enough for one sphere each. A ball is convex, so a triangle is inside when its three
// corners are, and the surface is inside when all triangles are.
#pragma once

#include "engine/model/mesh_distance.h"
#include "engine/types/sphere_tree.h"

#include <vector>

namespace fathom {

// Either the number of spheres or the allowed protrusion.
struct CoverOptions {
    uint32_t leaves = 128;   // at most; ignored when protrusion > 0
    double protrusion = 0.0; // [m] allowed; > 0 = as few spheres as possible
    uint32_t effort = 2;     // rounds of refitting, 0..8
};

// Spheres that contain the mesh, and their protrusion.
struct Cover {
    std::vector<Sphere> spheres;
    // [m] proven: no point of any sphere is farther than this from the mesh (outside of a solid; from its
    // surface on either side when the mesh has no inside). max of signed distance of the centre + radius.
    double protrusionBound = 0.0;
    size_t pieces = 0; // small triangles, and cells of the inside, that were covered
};

// The interior of a solid mesh is covered as well, by cells. Deterministic. Throws Error when more than
// kMaxLeaves would be needed, or `protrusion` is too small for two million pieces.
Cover coverMesh(const TriangleMesh& mesh, const MeshDistance& distance, const CoverOptions& options);

} // namespace fathom
