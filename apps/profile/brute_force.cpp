// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/brute_force.h"

#include "engine/contact/clones.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr size_t kBlock = 4096; // spheres that fit the first-level cache while all leaves are tested

FATHOM_CLONES
void markBlock(const float* __restrict x, const float* __restrict y, const float* __restrict z,
               const float* __restrict radius, size_t count, float cx, float cy, float cz, float reachAndLeaf,
               uint8_t* __restrict marks) noexcept {
    for (size_t k = 0; k < count; ++k) {
        const float dx = cx - x[k], dy = cy - y[k], dz = cz - z[k];
        const float limit = reachAndLeaf + radius[k];
        marks[k] |= static_cast<uint8_t>(dx * dx + dy * dy + dz * dz <= limit * limit ? 1 : 0);
    }
}

} // namespace

void bruteForceCull(const PosedLeaves& leaves, float reach, const RegionSpheres& s,
                    std::vector<uint8_t>& marks, std::vector<uint32_t>& found) {
    marks.assign(s.size(), 0);
    for (size_t begin = 0; begin < s.size(); begin += kBlock) {
        const size_t count = std::min(kBlock, s.size() - begin);
        for (size_t i = 0; i < leaves.x.size(); ++i) {
            markBlock(s.x.data() + begin, s.y.data() + begin, s.z.data() + begin, s.radius.data() + begin,
                      count, leaves.x[i], leaves.y[i], leaves.z[i], reach + leaves.radius[i],
                      marks.data() + begin);
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
