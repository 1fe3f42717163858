// SPDX-License-Identifier: Apache-2.0
// Spheres fitted to parts of a surface.
#pragma once

#include "engine/model/cover_parts.h"
#include "engine/model/piece_groups.h"
#include "engine/types/sphere_tree.h"

namespace fathom {

// The pieces that a cover must contain, and candidates for centres.
struct CoverFitting {
    const TriangleMesh& mesh;
    const MeshDistance& distance;
    std::vector<CoverPiece> pieces;
    PieceGroups groups;
    std::vector<CoverCentre> centres;
};

// Radius that a sphere about c needs to contain the part [m].
double radiusAround(const std::vector<CoverPiece>& pieces, const CoverShare& share, const dvec3& c);

// [m] by which a sphere protrudes, at most: from the signed distance of its centre.
double protrusionOf(const MeshDistance& distance, const Sphere& s);

// Largest protrusion of the spheres [m].
double worstOf(const CoverFitting& f, const std::vector<Sphere>& spheres);

// Assigns each piece to the sphere that would protrude least when it contains the piece.
std::vector<CoverShare> sharesOfCover(const CoverFitting& f, const std::vector<Sphere>& spheres);

// A sphere that contains the part and protrudes as little as a pattern search finds.
Sphere sphereAround(const CoverFitting& f, const CoverShare& share);

// Fits every sphere to its part; spheres without a part are removed.
std::vector<Sphere> fitSpheres(const CoverFitting& f, const std::vector<Sphere>& spheres);

} // namespace fathom
