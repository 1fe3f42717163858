// SPDX-License-Identifier: Apache-2.0
// The smallest gap between a tool at a pose and the region spheres of a set, at any distance. The gap of a
// pair is exactGap() with the leaf's centre (position - origin) + rotation * centre. Every search gives the
// same answer to the last bit: the smallest gap of all pairs; on ties the pair that comesBefore() all others.
#pragma once

#include "engine/contact/host_fixtures.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <glm/vec4.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace fathom {

// The answer for one pose, and the pair that has the gap.
struct SmallestGap {
    static constexpr uint32_t kNone = UINT32_MAX;
    double gap = std::numeric_limits<double>::infinity(); // [m] < 0 = overlap; infinity = no spheres; NaN =
                                                          // the pose is not finite
    uint32_t source = kNone;                              // RegionSpheres::source
    uint32_t leaf = kNone;                                // index in the tool
    uint32_t fixture = kNone;                             // index into Scene::fixtures

    glm::vec4 sphere{0.0f}; // [m] the region sphere: centre about the set's origin, and radius

    bool any() const { return source != kNone; }
    bool operator==(const SmallestGap&) const = default;
};

// Order of answers: gap, then source, fixture and leaf.
bool comesBefore(const SmallestGap& a, const SmallestGap& b) noexcept;

// The gap as defined above. leaf: leafAt(). sphere: centre about the set's origin, and radius [m].
double gapBetween(const glm::dvec4& leaf, const glm::vec4& sphere) noexcept;
// Centre of a leaf at a pose, about the set's origin, and its radius [m].
glm::dvec4 leafAt(const Sphere& leaf, const Pose& baseTtool, const dvec3& origin) noexcept;

// Searches on the host: blocks of consecutive spheres, nearest bound first. One thread.
class GapSearch {
public:
    // Bounds the blocks of a set, which must stay unchanged until the last find(). Allocates.
    void build(const HostFixtures& set);
    // Allocates only for a tool or a set that is larger than any before.
    SmallestGap find(const Tool& tool, const Pose& baseTtool);

private:
    struct Block {
        dvec3 centre;
        double radius; // encloses the block's spheres
    };
    void listBlocks(const glm::dvec4& bound);
    void seed(size_t block, const glm::dvec4& bound, SmallestGap& best) const;
    void searchBlock(size_t block, SmallestGap& best) const;
    void tryPair(size_t sphere, size_t leaf, SmallestGap& best) const;
    glm::vec4 sphereAt(size_t i) const;

    const HostFixtures* set_ = nullptr;
    std::vector<Block> blocks_;
    std::vector<glm::dvec4> leaves_;                 // leafAt() of the pose
    std::vector<std::pair<double, uint32_t>> queue_; // a heap of lower bounds [m] and blocks
};

} // namespace fathom
