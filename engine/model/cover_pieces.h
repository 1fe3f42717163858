// SPDX-License-Identifier: Apache-2.0
// The pieces that a sphere cover must contain, and the candidate centres of its spheres.
#pragma once

#include "engine/model/mesh_distance.h"

#include <cstdint>
#include <vector>

namespace fathom {

// A small triangle of the surface, or a cell of the interior (all corners equal, `margin` = half diagonal).
struct CoverPiece {
    static constexpr uint32_t kNoTriangle = ~0u;

    dvec3 corner[3];
    dvec3 middle{0.0};
    double reach = 0.0;              // [m] from the middle to the farthest corner, margin included
    double margin = 0.0;             // [m]
    double depth = 0.0;              // [m] of the middle inside the mesh; 0 on the surface
    uint32_t triangle = kNoTriangle; // of the mesh

    // Radius that a sphere about c needs to contain the piece [m].
    double radiusFrom(const dvec3& c) const;
};

// The surface cut until no edge is longer than `edge` [m], and for a solid cells of the inside `cell` apart.
std::vector<CoverPiece> cutToPieces(const TriangleMesh& mesh, const MeshDistance& distance, double edge,
                                    double cell);

// How many triangles of the surface that would be, at most.
double countOfPieces(const TriangleMesh& mesh, double edge);

// A candidate centre with its depth inside the mesh: a sphere of radius depth + e protrudes by at most e.
struct CoverCentre {
    dvec3 centre;
    double depth; // [m] = - signed distance
};

// About `count` candidates: centres of maximal inner balls at sampled pieces (shrinking ball, Ma et al.
// 2012), points between those and the surface, the centre of the box, and points of the surface.
std::vector<CoverCentre> findCentres(const TriangleMesh& mesh, const MeshDistance& distance,
                                     const std::vector<CoverPiece>& pieces, size_t count);

} // namespace fathom
