// SPDX-License-Identifier: Apache-2.0
// Sphere tree: a complete tree of fixed degree in breadth-first order, as in the .sph files of the
// Sphere-Tree Toolkit.
#pragma once

#include "engine/types/pose.h"

#include <cstddef>
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

inline constexpr size_t kMaxLeaves = 4096; // of a tool, or of an arm and its tool
// Limits of a tool's leaves [m]: what the contact query computes in float32 without losing a micrometre.
inline constexpr double kMaxToolReach = 50.0;  // of a coordinate of the centre
inline constexpr double kMinLeafRadius = 1e-5, // smallest radius
    kMaxLeafRadius = 10.0;                     // largest radius

// Node 0 is the root; child k of node n is n * degree + 1 + k. All leaves are on the last level. Every used
// node encloses the spheres of its used children.
struct SphereTree {
    uint32_t levels = 0; // including the root
    uint32_t degree = 0; // children per node
    std::vector<Sphere> nodes;

    uint32_t firstLeaf() const; // index of the first slot of the last level
    std::span<const Sphere> lastLevel() const;
};

// Builds an enclosing tree top-down (longest axis, median split, 2 children per node). Leaf order follows the
// split, not the input. Throws Error without spheres or when a radius is not positive.
SphereTree buildSphereTree(std::span<const Sphere> leaves);

// Empty when the tree is valid; otherwise one sentence that names the first invalid node.
std::string validate(const SphereTree& tree);

} // namespace fathom
