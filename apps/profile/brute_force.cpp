// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/brute_force.h"

#include "engine/contact/clones.h"
#include "engine/contact/sphere_span.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr size_t kBlock = 4096; // spheres that fit the first-level cache while all leaves are tested

FATHOM_CLONES
void markBlock(SphereSpan block, glm::vec3 leaf, float limit, uint8_t* __restrict marks) noexcept {
    for (size_t k = 0; k < block.count; ++k) {
        const float dx = leaf.x - block.x[k], dy = leaf.y - block.y[k], dz = leaf.z - block.z[k];
        const float far = limit + block.radius[k];
        marks[k] |= static_cast<uint8_t>(dx * dx + dy * dy + dz * dz <= far * far ? 1 : 0);
    }
}

} // namespace

void bruteForceCull(const PosedLeaves& leaves, float reach, const RegionSpheres& s,
                    std::vector<uint8_t>& marks, std::vector<uint32_t>& found) {
    marks.assign(s.size(), 0);
    for (size_t begin = 0; begin < s.size(); begin += kBlock) {
        const SphereSpan block =
            part({s.x.data(), s.y.data(), s.z.data(), s.radius.data(), s.size()}, begin, kBlock);
        for (size_t i = 0; i < leaves.x.size(); ++i) {
            markBlock(block, leaves.centre(i), reach + leaves.radius[i], marks.data() + begin);
        }
    }
    found.clear();
    for (size_t i = 0; i < marks.size(); ++i) {
        if (marks[i] != 0) {
            found.push_back(static_cast<uint32_t>(i));
        }
    }
}

} // namespace fathom::profile
