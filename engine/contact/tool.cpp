// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/tool.h"

#include "engine/types/error.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace fathom {

namespace {

void checkTree(const SphereTree& tree) {
    const std::string fault = validate(tree);
    if (!fault.empty()) {
        throw Error(fault);
    }
}

void checkLeaf(const Sphere& leaf, size_t index) {
    const dvec3 far = glm::abs(leaf.centre);
    if (!(std::max({far.x, far.y, far.z}) <= kMaxToolReach) || !(leaf.radius <= kMaxLeafRadius)) {
        throw Error(printed("leaf %zu at (%.6g, %.6g, %.6g) m with radius %.6g m exceeds %g m or %g m", index,
                            leaf.centre.x, leaf.centre.y, leaf.centre.z, leaf.radius, kMaxToolReach,
                            kMaxLeafRadius));
    }
}

} // namespace

Tool::Tool(SphereTree tree)
    : tree_(std::move(tree)) {
    checkTree(tree_);
    double sumOfSquares = 0.0;
    double largestRadius = 0.0;
    for (const Sphere& leaf : tree_.lastLevel()) {
        if (leaf.radius < 0.0) {
            continue;
        }
        checkLeaf(leaf, leaves_.size());
        leaves_.push_back(leaf);
        sumOfSquares += glm::dot(leaf.centre, leaf.centre);
        largestRadius = std::max(largestRadius, leaf.radius);
        boundingRadius_ = std::max(boundingRadius_, glm::length(leaf.centre) + leaf.radius);
    }
    if (leaves_.empty() || leaves_.size() > kMaxLeaves) {
        throw Error(std::to_string(leaves_.size()) + " leaf spheres (allowed: 1 to " +
                    std::to_string(kMaxLeaves) + ")");
    }
    gyrationRadius_ = std::max(std::sqrt(sumOfSquares / static_cast<double>(leaves_.size())), largestRadius);
}

void poseLeaves(const Tool& tool, const Pose& baseTtool, const dvec3& origin, PosedLeaves& out) {
    const size_t count = tool.leafCount();
    out.x.resize(count);
    out.y.resize(count);
    out.z.resize(count);
    out.radius.resize(count);
    // Subtract the two large numbers first: kilometres from the base frame's origin they cancel exactly.
    const dvec3 centre = baseTtool.position - origin;
    for (size_t i = 0; i < count; ++i) {
        const Sphere& leaf = tool.leaves()[i];
        const dvec3 c = centre + baseTtool.rotation * leaf.centre;
        out.x[i] = static_cast<float>(c.x);
        out.y[i] = static_cast<float>(c.y);
        out.z[i] = static_cast<float>(c.z);
        out.radius[i] = static_cast<float>(leaf.radius);
    }
}

} // namespace fathom
