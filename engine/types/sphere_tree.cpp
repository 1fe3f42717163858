// SPDX-License-Identifier: Apache-2.0
#include "engine/types/sphere_tree.h"

#include "engine/types/error.h"

#include <algorithm>

namespace fathom {

namespace {

uint64_t nodesAbove(uint32_t levels, uint32_t degree) {
    uint64_t count = 0, width = 1;
    for (uint32_t l = 0; l < levels; ++l, width *= degree) {
        count += width;
    }
    return count;
}

// Sorts [first, last) so that each half is compact: median along the longest axis of the centres' box.
void splitMedian(std::span<Sphere> part) {
    dvec3 lo = part[0].centre, hi = lo;
    for (const Sphere& s : part) {
        lo = glm::min(lo, s.centre);
        hi = glm::max(hi, s.centre);
    }
    const dvec3 size = hi - lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    std::nth_element(part.begin(), part.begin() + static_cast<long>(part.size() / 2), part.end(),
                     [axis](const Sphere& a, const Sphere& b) { return a.centre[axis] < b.centre[axis]; });
}

void placeLeaves(SphereTree& tree, uint64_t node, uint32_t level, std::span<Sphere> part) {
    if (level + 1 == tree.levels) {
        if (!part.empty()) {
            tree.nodes[node] = part[0];
        }
        return;
    }
    size_t half = part.size();
    if (part.size() > 1) {
        splitMedian(part);
        half = part.size() / 2;
    }
    placeLeaves(tree, node * 2 + 1, level + 1, part.first(half));
    placeLeaves(tree, node * 2 + 2, level + 1, part.subspan(half));
}

// Parent sphere about the mean of the used children, as in paper eq. 3 for patches.
void encloseChildren(SphereTree& tree, uint64_t node) {
    dvec3 mean{0.0};
    double count = 0.0;
    for (uint32_t k = 0; k < tree.degree; ++k) {
        const Sphere& child = tree.nodes[node * tree.degree + 1 + k];
        if (child.radius >= 0.0) {
            mean += child.centre;
            count += 1.0;
        }
    }
    if (count == 0.0) {
        return;
    }
    Sphere& parent = tree.nodes[node];
    parent.centre = mean / count;
    for (uint32_t k = 0; k < tree.degree; ++k) {
        const Sphere& child = tree.nodes[node * tree.degree + 1 + k];
        if (child.radius >= 0.0) {
            parent.radius =
                std::max(parent.radius, glm::distance(parent.centre, child.centre) + child.radius);
        }
    }
    parent.radius *= 1.0 + 1e-12; // rounded outward
}

} // namespace

uint32_t SphereTree::firstLeaf() const {
    return static_cast<uint32_t>(nodesAbove(levels - 1, degree));
}

std::span<const Sphere> SphereTree::lastLevel() const {
    return std::span(nodes).subspan(firstLeaf());
}

SphereTree buildSphereTree(std::span<const Sphere> leaves) {
    if (leaves.empty()) {
        throw Error("a sphere tree needs at least one sphere");
    }
    for (const Sphere& s : leaves) {
        if (!(s.radius > 0.0) || !isFinite(s.centre)) {
            throw Error("a sphere tree needs finite centres and positive radii");
        }
    }
    SphereTree tree;
    tree.degree = 2;
    tree.levels = 1;
    while ((uint64_t{1} << (tree.levels - 1)) < leaves.size()) {
        ++tree.levels;
    }
    tree.nodes.resize(nodesAbove(tree.levels, tree.degree));
    std::vector<Sphere> order(leaves.begin(), leaves.end());
    placeLeaves(tree, 0, 0, order);
    for (uint64_t node = tree.firstLeaf(); node-- > 0;) {
        encloseChildren(tree, node);
    }
    return tree;
}

std::string validate(const SphereTree& tree) {
    if (tree.levels == 0 || tree.degree == 0 || tree.nodes.size() != nodesAbove(tree.levels, tree.degree)) {
        return "the node count does not match levels and degree";
    }
    for (uint64_t n = 0; n < tree.firstLeaf(); ++n) {
        for (uint32_t k = 0; k < tree.degree; ++k) {
            const uint64_t c = n * tree.degree + 1 + k;
            const Sphere& child = tree.nodes[c];
            if (child.radius < 0.0) {
                continue;
            }
            const double reach = glm::distance(tree.nodes[n].centre, child.centre) + child.radius;
            if (!(tree.nodes[n].radius >= reach)) {
                return "node " + std::to_string(n) + " does not enclose its child " + std::to_string(c);
            }
        }
    }
    return {};
}

} // namespace fathom
