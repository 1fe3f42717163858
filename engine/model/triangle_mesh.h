// SPDX-License-Identifier: Apache-2.0
// A triangle mesh as a sphere cover needs it: every point once, every face once, faces of a closed part
// turned outwards.
#pragma once

#include "engine/types/pose.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fathom {

struct TriangleMesh {
    std::vector<dvec3> points; // [m]
    std::vector<std::array<uint32_t, 3>> triangles;

    dvec3 corner(size_t triangle, int k) const { return points[triangles[triangle][static_cast<size_t>(k)]]; }
    double area(size_t triangle) const;  // [m^2]
    dvec3 normal(size_t triangle) const; // unit, by the order of the corners; zero where there is no area
    double area() const;
    double volume() const; // [m^3] signed: positive when a closed mesh is turned outwards
    dvec3 low() const;     // corners of the box; zero without points
    dvec3 high() const;
};

// What a mesh turned out to be, and what was done about it.
struct MeshFacts {
    size_t faces = 0;           // as read
    size_t noArea = 0;          // faces left out: two corners the same, or in a line
    size_t doubled = 0;         // faces left out: the same three corners as another, either way round
    size_t turned = 0;          // faces whose order of corners was reversed, so that all of a part agree
    size_t openEdges = 0;       // edges of one face only
    size_t crowdedEdges = 0;    // edges of three faces or more
    size_t parts = 0;           // connected pieces
    size_t strayParts = 0;      // pieces far from the largest: see dropStray()
    double strayFarthest = 0.0; // [m] from the box of the main pieces to the farthest stray one
    bool closed() const { return openEdges == 0 && crowdedEdges == 0; }
};

// Merges points nearer than `weld` [m], drops faces without area and doubled ones, turns faces so that
// neighbours agree and closed parts have positive volume. weld <= 0: only equal points are merged.
MeshFacts tidy(TriangleMesh& mesh, double weld);

// Pieces farther from everything gathered so far than the diagonal of the largest piece's box are stray:
// left-over geometry of drawing programs. Grown from the largest piece (by area) outwards. Fills strayParts
// and strayFarthest; takes them out when `drop`.
void findStray(TriangleMesh& mesh, MeshFacts& facts, bool drop);

} // namespace fathom
