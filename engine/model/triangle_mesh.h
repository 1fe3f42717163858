// SPDX-License-Identifier: Apache-2.0
// A clean triangle mesh for sphere covers: unique points, unique faces, and outward normals on closed parts.
#pragma once

#include "engine/types/pose.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fathom {

struct TriangleMesh {
    std::vector<dvec3> points; // [m]
    std::vector<std::array<uint32_t, 3>> triangles;

    dvec3 corner(size_t triangle, int k) const { return points[triangles[triangle][static_cast<size_t>(k)]]; }
    double area(size_t triangle) const;  // [m^2]
    dvec3 normal(size_t triangle) const; // unit, by the winding of the corners; zero for a face without area
    double area() const;
    double volume() const; // [m^3] signed: positive for a closed mesh with outward normals; for tests
    dvec3 low() const;     // corners of the box; zero without points
    dvec3 high() const;
};

// Facts about a mesh as read, and what cleaning changed.
struct MeshFacts {
    size_t faces = 0;           // as read
    size_t noArea = 0;          // faces dropped: degenerate
    size_t doubled = 0;         // faces dropped: same three corners as another face, in either winding
    size_t turned = 0;          // faces whose winding was reversed to agree with their part
    size_t openEdges = 0;       // edges with one face
    size_t crowdedEdges = 0;    // edges with three or more faces
    size_t parts = 0;           // connected pieces
    size_t strayParts = 0;      // pieces far from the largest: see dropStray()
    double strayFarthest = 0.0; // [m] from the box of the main pieces to the farthest stray one
    bool closed() const { return openEdges == 0 && crowdedEdges == 0; }
};

// Merges points closer than `weld` [m], drops degenerate and duplicate faces, and flips faces so that
// neighbours agree and closed parts have positive volume. weld <= 0 merges only equal points.
MeshFacts tidy(TriangleMesh& mesh, double weld);

// Finds stray pieces, which drawing programs leave behind. Starting from the largest piece by area, a piece
// is stray when its distance to all gathered pieces exceeds the diagonal D of the largest piece's box and it
// is no like part: a quarter to three times as large, at most 10 D or 0.5 m away. Fills strayParts and
// strayFarthest; removes the pieces when `drop` is set.
void findStray(TriangleMesh& mesh, MeshFacts& facts, bool drop);

} // namespace fathom
