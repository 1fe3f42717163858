// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/sphere_blocks.h"

#include "engine/types/pose.h"
#include "shaders/shared/query_params.h"

#include <algorithm>
#include <vector>

namespace fathom::cloud {

namespace {

using shared::kBlockSlots;

constexpr double kOutward = 1.000001; // for the rounding of the bound to float32

} // namespace

uint32_t SphereBlocks::firstBound() const {
    return count_ * kBlockSlots;
}

bool SphereBlocks::fill(std::span<const glm::vec4> spheres) {
    count_ = static_cast<uint32_t>((spheres.size() + kBlockSlots - 1) / kBlockSlots);
    const uint64_t bytes = 16ull * count_ * (kBlockSlots + 1);
    const bool larger = bytes > blocks_.bytes();
    if (larger) {
        blocks_ = gpu::Buffer(device_, bytes, gpu::MemoryKind::Device, "sphere blocks");
        written_ = gpu::Buffer(device_, bytes, gpu::MemoryKind::Upload, "sphere blocks");
    }
    for (uint32_t block = 0; block < count_; ++block) {
        const auto out = written_.as<glm::vec4>();
        const auto rest = spheres.subspan(size_t{block} * kBlockSlots);
        fillBlock(rest.first(std::min<size_t>(kBlockSlots, rest.size())), &out[size_t{block} * kBlockSlots],
                  out[firstBound() + block]);
    }
    changed_ = count_ > 0;
    return larger;
}

bool SphereBlocks::fillFrozen(const FixtureSet& set) {
    if (set.frozenVersion == frozenVersion_) {
        return false;
    }
    frozenVersion_ = set.frozenVersion;
    std::vector<glm::vec4> spheres;
    for (size_t i = 0; set.frozen && i < set.frozen->size(); ++i) {
        const RegionSpheres& s = *set.frozen;
        spheres.emplace_back(s.x[i], s.y[i], s.z[i], s.radius[i]);
    }
    return fill(spheres);
}

void SphereBlocks::fillBlock(std::span<const glm::vec4> spheres, glm::vec4* slots, glm::vec4& bound) const {
    dvec3 sum(0.0);
    for (const glm::vec4& s : spheres) {
        sum += dvec3(s);
    }
    const glm::vec3 centre(sum / static_cast<double>(spheres.size()));
    double radius = 0.0;
    for (const glm::vec4& s : spheres) {
        radius = std::max(radius, glm::distance(dvec3(s), dvec3(centre)) + double{s.w});
    }
    std::ranges::copy(spheres, slots);
    std::fill(slots + spheres.size(), slots + kBlockSlots, glm::vec4(0, 0, 0, -1));
    bound = glm::vec4(centre, static_cast<float>(radius * kOutward));
}

bool SphereBlocks::upload(gpu::Commands& commands) {
    if (!changed_) {
        return false;
    }
    commands.copy(written_, blocks_, 16ull * count_ * (kBlockSlots + 1));
    changed_ = false;
    return true;
}

} // namespace fathom::cloud
