// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/near_pairs.h"

#include "engine/contact/exact_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fathom {

namespace {

void orderBySource(const std::vector<NearSphere>& spheres, DecideScratch& scratch) {
    scratch.order.resize(spheres.size());
    std::iota(scratch.order.begin(), scratch.order.end(), 0u);
    scratch.sort.keys.resize(spheres.size());
    std::ranges::transform(spheres, scratch.sort.keys.begin(), &NearSphere::source);
    sortBySource(scratch.order, scratch.sort);
}

void addSphere(const NearSphere& s, ContactSet& set) {
    set.x.push_back(s.x);
    set.y.push_back(s.y);
    set.z.push_back(s.z);
    set.radius.push_back(s.radius);
    set.source.push_back(s.source);
    set.fixture.push_back(static_cast<uint8_t>(s.fixture));
}

} // namespace

float outwardReach(double toolRadius, double away, double reach, double largest) noexcept {
    const double near = toolRadius + reach + largest;
    const double outward = reach + kPairMargin + 0x1p-22 * (away + 16.0 * near);
    return std::nextafter(static_cast<float>(outward), std::numeric_limits<float>::infinity());
}

bool decidePairs(const Tool& tool, const NearPairs& near, size_t mostPairs, DecideScratch& scratch,
                 ContactSet& set) {
    orderBySource(near.spheres, scratch);
    scratch.leaves.resize(tool.leafCount());
    for (size_t i = 0; i < tool.leafCount(); ++i) {
        scratch.leaves[i] = glm::dvec4(set.leafAtQuery[i], tool.leaves()[i].radius);
    }
    const double limit = set.reach + kPairMargin;
    ListedPairs& pairs = scratch.pairs;
    pairs.resize(std::min(near.leaves.size(), mostPairs));
    size_t listed = 0;
    for (const uint32_t i : scratch.order) {
        const NearSphere& s = near.spheres[i];
        for (const uint32_t leaf : near.leaves.subspan(s.first, s.count)) {
            const glm::dvec4& l = scratch.leaves[leaf];
            const double gap = exactGap(l.x, l.y, l.z, l.w, s.x, s.y, s.z, s.radius);
            if (!(gap <= limit)) {
                continue;
            }
            if (listed == pairs.size()) {
                return false;
            }
            if (set.source.empty() || set.source.back() != s.source) {
                addSphere(s, set);
            }
            pairs.bucket[listed] = leaf * ContactSet::kGapBands + set.bandOf(gap);
            pairs.sphere[listed++] = static_cast<uint32_t>(set.size() - 1);
        }
    }
    pairs.resize(listed);
    placePairs(pairs, scratch.next, set);
    return true;
}

// A stable counting sort by leaf and band.
void placePairs(const ListedPairs& pairs, std::vector<uint32_t>& next, ContactSet& set) {
    constexpr uint32_t kBands = ContactSet::kGapBands;
    const size_t leaves = set.leafCount(), count = pairs.size();
    std::vector<uint32_t>& end = set.pairBandEnd;
    end.assign(leaves * kBands, 0);
    for (size_t k = 0; k < count; ++k) {
        ++end[pairs.bucket[k]];
    }
    next.resize(end.size());
    std::exclusive_scan(end.begin(), end.end(), next.begin(), 0u);
    std::inclusive_scan(end.begin(), end.end(), end.begin());
    set.pairBegin.resize(leaves + 1);
    set.pairBegin[0] = 0;
    for (size_t leaf = 0; leaf < leaves; ++leaf) {
        set.pairBegin[leaf + 1] = end[leaf * kBands + kBands - 1];
    }
    set.pairSphere.resize(count);
    for (size_t k = 0; k < count; ++k) {
        set.pairSphere[next[pairs.bucket[k]]++] = pairs.sphere[k];
    }
    set.pairX.resize(count);
    set.pairY.resize(count);
    set.pairZ.resize(count);
    set.pairRadius.resize(count);
    for (size_t k = 0; k < count; ++k) { // exact: the values were floats
        const uint32_t s = set.pairSphere[k];
        set.pairX[k] = static_cast<float>(set.x[s]);
        set.pairY[k] = static_cast<float>(set.y[s]);
        set.pairZ[k] = static_cast<float>(set.z[s]);
        set.pairRadius[k] = static_cast<float>(set.radius[s]);
    }
}

} // namespace fathom
