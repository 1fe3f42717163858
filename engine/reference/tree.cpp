// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/tree.h"

#include <algorithm>

namespace fathom::reference {

namespace {

// Indices on the level below of the children of node (u, v).
std::vector<size_t> childrenOf(const PatchLayout& layout, size_t level, uint32_t u, uint32_t v) {
    const PatchLayout::Level& below = layout.levels[level - 1];
    std::vector<size_t> children;
    for (uint32_t y = 4 * v; y < std::min(4 * v + 4, below.down); ++y) {
        for (uint32_t x = 4 * u; x < std::min(4 * u + 4, below.across); ++x) {
            children.push_back(static_cast<size_t>(y) * below.across + x);
        }
    }
    return children;
}

Bound parentOf(const std::vector<Bound>& below, const std::vector<size_t>& children) {
    Bound parent;
    dvec3 sum(0.0);
    for (const size_t k : children) {
        sum += below[k].centre * static_cast<double>(below[k].count);
        parent.count += below[k].count;
    }
    if (parent.count == 0) {
        return parent;
    }
    parent.centre = sum / static_cast<double>(parent.count);
    for (const size_t k : children) {
        if (below[k].count != 0) {
            parent.radius =
                std::max(parent.radius, glm::distance(below[k].centre, parent.centre) + below[k].radius);
        }
    }
    return parent;
}

std::string checkNode(const std::vector<Bound>& below, const std::vector<size_t>& children,
                      const Bound& node) {
    uint32_t count = 0;
    for (const size_t k : children) {
        count += below[k].count;
        if (below[k].count != 0 &&
            !(glm::distance(below[k].centre, node.centre) + below[k].radius <= node.radius)) {
            return "does not enclose its child " + std::to_string(k);
        }
    }
    if (count != node.count) {
        return "counts " + std::to_string(node.count) + " points, its children " + std::to_string(count);
    }
    return (node.count == 0) == (node.radius < 0.0) ? "" : "radius and count disagree on whether it is empty";
}

} // namespace

std::vector<Bound> parents(const PatchLayout& layout, size_t level, const std::vector<Bound>& below) {
    std::vector<Bound> nodes;
    for (uint32_t v = 0; v < layout.levels[level].down; ++v) {
        for (uint32_t u = 0; u < layout.levels[level].across; ++u) {
            nodes.push_back(parentOf(below, childrenOf(layout, level, u, v)));
        }
    }
    return nodes;
}

std::string validateTree(const PatchLayout& layout, const std::vector<std::vector<Bound>>& levels) {
    for (size_t level = 1; level < levels.size(); ++level) {
        for (uint32_t v = 0; v < layout.levels[level].down; ++v) {
            for (uint32_t u = 0; u < layout.levels[level].across; ++u) {
                const Bound& node = levels[level][static_cast<size_t>(v) * layout.levels[level].across + u];
                const std::string wrong = checkNode(levels[level - 1], childrenOf(layout, level, u, v), node);
                if (!wrong.empty()) {
                    return "level " + std::to_string(level) + " node " + std::to_string(u) + "," +
                           std::to_string(v) + " " + wrong;
                }
            }
        }
    }
    return {};
}

} // namespace fathom::reference
