// SPDX-License-Identifier: Apache-2.0
// Sphere tree: a complete tree of fixed degree, breadth first, as the .sph files of the Sphere-Tree Toolkit
// store it.
#pragma once

#include "engine/types/pose.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// One sphere, in the frame of its owner.
struct Sphere {
    dvec3 centre{0.0};    // [m]
    double radius = -1.0; // [m]; negative = unused slot
};

// Node 0 is the root; child k of node n is n * degree + 1 + k. All leaves lie on the last level; every used
// node encloses the spheres of its used children.
struct SphereTree {
    uint32_t levels = 0; // counts the root
    uint32_t degree = 0; // children a node
    std::vector<Sphere> nodes;

    uint32_t firstLeaf() const; // index of the first slot of the last level
    std::span<const Sphere> lastLevel() const;
};

// Groups a flat set of spheres top-down (longest axis, median split, 2 children per node) into a tree that
// encloses them. Leaf order follows the split, not the input. At least one sphere; radii must be positive:
// throws Error.
SphereTree buildSphereTree(std::span<const Sphere> leaves);

// Empty when the tree is sound; otherwise one sentence that names the first node that breaks a rule.
std::string validate(const SphereTree& tree);

} // namespace fathom
