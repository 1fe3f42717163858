// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/smallest_gap.h"

#include "engine/contact/exact_gap.h"

#include <algorithm>
#include <functional>
#include <tuple>

namespace fathom {

namespace {

constexpr size_t kBlockSpheres = 256;
constexpr double kBoundSlack = 1e-9; // [m] exceeds every rounding of a bound in float64

double distanceOf(const glm::dvec4& a, const glm::dvec4& b) noexcept {
    return glm::distance(dvec3(a), dvec3(b));
}

// A sphere around all leaves at the pose.
glm::dvec4 boundOf(std::span<const glm::dvec4> leaves) noexcept {
    dvec3 sum(0.0);
    for (const glm::dvec4& leaf : leaves) {
        sum += dvec3(leaf);
    }
    glm::dvec4 bound(sum / static_cast<double>(leaves.size()), 0.0);
    for (const glm::dvec4& leaf : leaves) {
        bound.w = std::max(bound.w, distanceOf(leaf, bound) + leaf.w);
    }
    return bound;
}

} // namespace

bool comesBefore(const SmallestGap& a, const SmallestGap& b) noexcept {
    return std::tie(a.gap, a.source, a.fixture, a.leaf) < std::tie(b.gap, b.source, b.fixture, b.leaf);
}

double gapBetween(const glm::dvec4& leaf, const glm::vec4& sphere) noexcept {
    return exactGap({dvec3(leaf), leaf.w}, sphere.x, sphere.y, sphere.z, sphere.w);
}

glm::dvec4 leafAt(const Sphere& leaf, const Pose& baseTtool, const dvec3& origin) noexcept {
    return {(baseTtool.position - origin) + baseTtool.rotation * leaf.centre, leaf.radius};
}

glm::vec4 GapSearch::sphereAt(size_t i) const {
    const RegionSpheres& s = set_->spheres;
    return {s.x[i], s.y[i], s.z[i], s.radius[i]};
}

void GapSearch::build(const HostFixtures& set) {
    set_ = &set;
    blocks_.clear();
    const size_t count = set.spheres.size();
    for (size_t begin = 0; begin < count; begin += kBlockSpheres) {
        const size_t end = std::min(count, begin + kBlockSpheres);
        Block block{dvec3(0.0), 0.0};
        for (size_t i = begin; i < end; ++i) {
            block.centre += dvec3(sphereAt(i));
        }
        block.centre /= static_cast<double>(end - begin);
        for (size_t i = begin; i < end; ++i) {
            const glm::dvec4 s(sphereAt(i));
            block.radius = std::max(block.radius, glm::distance(dvec3(s), block.centre) + s.w);
        }
        blocks_.push_back(block);
    }
}

void GapSearch::listBlocks(const glm::dvec4& bound) {
    queue_.clear();
    for (uint32_t i = 0; i < blocks_.size(); ++i) {
        const double lower = glm::distance(blocks_[i].centre, dvec3(bound)) - blocks_[i].radius - bound.w;
        queue_.emplace_back(lower, i);
    }
    std::make_heap(queue_.begin(), queue_.end(), std::greater<>());
}

void GapSearch::tryPair(size_t sphere, size_t leaf, SmallestGap& best) const {
    const RegionSpheres& s = set_->spheres;
    const glm::vec4 at = sphereAt(sphere);
    const SmallestGap pair{gapBetween(leaves_[leaf], at), s.source[sphere], static_cast<uint32_t>(leaf),
                           s.fixture[sphere], at};
    if (comesBefore(pair, best)) {
        best = pair;
    }
}

// All leaves against the block's sphere that is nearest to the tool's middle: a good first gap for little
// work.
void GapSearch::seed(size_t block, const glm::dvec4& bound, SmallestGap& best) const {
    const size_t begin = block * kBlockSpheres, end = std::min(set_->spheres.size(), begin + kBlockSpheres);
    size_t nearest = begin;
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = begin; i < end; ++i) {
        const double gap = gapBetween(bound, sphereAt(i));
        nearest = gap < least ? i : nearest;
        least = std::min(gap, least);
    }
    for (size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        tryPair(nearest, leaf, best);
    }
}

void GapSearch::searchBlock(size_t block, SmallestGap& best) const {
    const size_t begin = block * kBlockSpheres, end = std::min(set_->spheres.size(), begin + kBlockSpheres);
    for (size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        const glm::dvec4& l = leaves_[leaf];
        if (glm::distance(dvec3(l), blocks_[block].centre) - blocks_[block].radius - l.w >
            best.gap + kBoundSlack) {
            continue;
        }
        for (size_t i = begin; i < end; ++i) {
            const glm::dvec4 s(sphereAt(i));
            const double limit = best.gap + kBoundSlack + l.w + s.w;
            const dvec3 d = dvec3(l) - dvec3(s);
            if (limit >= 0.0 && glm::dot(d, d) <= limit * limit) {
                tryPair(i, leaf, best);
            }
        }
    }
}

SmallestGap GapSearch::find(const Tool& tool, const Pose& baseTtool) {
    SmallestGap best;
    if (!isFinite(baseTtool)) {
        best.gap = std::numeric_limits<double>::quiet_NaN();
        return best;
    }
    if (blocks_.empty()) {
        return best;
    }
    leaves_.clear();
    for (const Sphere& leaf : tool.leaves()) {
        leaves_.push_back(leafAt(leaf, baseTtool, set_->origin));
    }
    const glm::dvec4 bound = boundOf(leaves_);
    listBlocks(bound);
    seed(queue_.front().second, bound, best);
    for (; !queue_.empty() && queue_.front().first <= best.gap + kBoundSlack; queue_.pop_back()) {
        std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
        searchBlock(queue_.back().second, best);
    }
    return best;
}

} // namespace fathom
