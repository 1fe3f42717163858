// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/brute_force.h"

#include "engine/contact/cull_cpu.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr size_t kBlock = 4096; // spheres that fit the first-level cache while all leaves are tested

} // namespace

void bruteForceCull(const PosedLeaves& leaves, float reach, const RegionSpheres& s,
                    std::vector<uint8_t>& marks, std::vector<uint32_t>& found) {
    marks.assign(s.size(), 0);
    for (size_t begin = 0; begin < s.size(); begin += kBlock) {
        const SphereSpan block =
            part({s.x.data(), s.y.data(), s.z.data(), s.radius.data(), s.size()}, begin, kBlock);
        for (size_t i = 0; i < leaves.x.size(); ++i) {
            markWithin(block, leaves.centre(i), reach + leaves.radius[i], marks.data() + begin);
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
