// SPDX-License-Identifier: Apache-2.0
// What a sphere cover must contain, and where its spheres may sit.
#pragma once

#include "engine/model/mesh_distance.h"

#include <cstdint>
#include <vector>

namespace fathom {

// A small triangle of the surface, or a cell of the inside (all corners the same, `margin` its half
// diagonal).
struct CoverPiece {
    dvec3 corner[3];
    dvec3 middle{0.0};
    double reach = 0.0;  // [m] from the middle to the farthest corner, margin included
    double margin = 0.0; // [m]
    double depth = 0.0;  // [m] of the middle inside the mesh; 0 on the surface
    dvec3 inwards{0.0};  // unit; zero for cells and meshes without an inside

    // Radius that a sphere about c needs to contain the piece [m].
    double radiusFrom(const dvec3& c) const;
};

// The surface cut until no edge is longer than `edge` [m], and for a solid cells of the inside `cell` apart.
std::vector<CoverPiece> cutToPieces(const TriangleMesh& mesh, const MeshDistance& distance, double edge,
                                    double cell);

// How many triangles of the surface that would be, at most.
double countOfPieces(const TriangleMesh& mesh, double edge);

// Where a sphere may sit, and how deep that is inside: a sphere about it of radius depth + e stands out by at
// most e.
struct CoverSeat {
    dvec3 centre;
    double depth; // [m] = - signed distance
};

// Some `count` seats: centres of largest inner balls that touch the surface at sampled pieces (shrinking
// ball, Ma et al. 2012), places between those and the surface, the middle of the box, and pieces of the
// surface.
std::vector<CoverSeat> findSeats(const TriangleMesh& mesh, const MeshDistance& distance,
                                 const std::vector<CoverPiece>& pieces, size_t count);

} // namespace fathom
