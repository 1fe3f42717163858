// SPDX-License-Identifier: Apache-2.0
// Measures how well a set of spheres covers a mesh, by dense sampling that is independent of how the set was
// made.
#pragma once

#include "engine/model/mesh_distance.h"
#include "engine/types/sphere_tree.h"

#include <span>

namespace fathom {

struct CoverMeasure {
    double protrusionMax = 0.0,
           protrusionMean = 0.0; // [m] from the surface of the union outwards to the mesh
    double bound = 0.0;          // [m] proven: largest signed distance of a centre + radius
    uint64_t surfaceSamples = 0; // spread evenly by area, every corner of the mesh too
    uint64_t outside = 0;        // samples in no sphere
    double deepestGap = 0.0;     // [m] largest distance of such a sample to the nearest sphere
    double volumeRatio = 0.0;    // union over mesh; 0 for a mesh without an inside
    double insideCovered = 1.0;  // fraction of the mesh's volume that is inside some sphere
};

// `effort` 1: 100 000 points of the mesh's surface, 40 000 of the union's, 100 000 of the space. The mean is
// over the part of the union's surface that is outside the mesh and every other sphere. Deterministic.
CoverMeasure measureCover(std::span<const Sphere> spheres, const TriangleMesh& mesh,
                          const MeshDistance& distance, double effort = 1.0);

} // namespace fathom
