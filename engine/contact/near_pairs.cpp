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

void resizeSpheres(size_t count, ContactSet& set) {
    set.x.resize(count);
    set.y.resize(count);
    set.z.resize(count);
    set.radius.resize(count);
    set.source.resize(count);
    set.fixture.resize(count);
}

void setSphere(const NearSphere& s, size_t i, ContactSet& set) {
    set.x[i] = s.x;
    set.y[i] = s.y;
    set.z[i] = s.z;
    set.radius[i] = s.radius;
    set.source[i] = s.source;
    set.fixture[i] = static_cast<uint8_t>(s.fixture);
}

float upToFloat(double x) {
    return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

// The bucket of a pair that the query left undecided; kUndecided: not in the set.
uint32_t decide(uint32_t undecided, const NearSphere& s, const Tool& tool, const ContactSet& set) {
    const uint32_t leaf = (undecided & ~NearPairs::kUndecided) / ContactSet::kGapBands;
    const dvec3 c = set.leafAtQuery[leaf];
    const double gap = exactGap({c, tool.leaves()[leaf].radius}, s.x, s.y, s.z, s.radius);
    return gap <= set.reach + kPairMargin ? leaf * ContactSet::kGapBands + set.bandOf(gap)
                                          : NearPairs::kUndecided;
}

} // namespace

float searchError(double toolRadius, double away, double reach, double largest) noexcept {
    return upToFloat(0x1p-22 * (away + 16.0 * (toolRadius + reach + largest)));
}

float outwardReach(double toolRadius, double away, double reach, double largest) noexcept {
    return upToFloat(reach + kPairMargin + double{searchError(toolRadius, away, reach, largest)});
}

bool decidePairs(const Tool& tool, const NearPairs& near, size_t mostPairs, DecideScratch& scratch,
                 ContactSet& set) {
    orderBySource(near.spheres, scratch);
    ListedPairs& pairs = scratch.pairs;
    pairs.resize(std::min(near.buckets.size(), mostPairs));
    resizeSpheres(near.spheres.size(), set);
    size_t listed = 0, spheres = 0;
    for (const uint32_t i : scratch.order) {
        const NearSphere& s = near.spheres[i];
        const bool again = spheres != 0 && set.source[spheres - 1] == s.source; // with other leaves
        const size_t before = listed;
        for (uint32_t bucket : near.buckets.subspan(s.first, s.count)) {
            bucket = bucket < NearPairs::kUndecided ? bucket : decide(bucket, s, tool, set);
            if (bucket == NearPairs::kUndecided) {
                continue;
            }
            if (listed == pairs.size()) {
                resizeSpheres(spheres, set);
                return false;
            }
            pairs.bucket[listed] = bucket;
            pairs.sphere[listed++] = static_cast<uint32_t>(again ? spheres - 1 : spheres);
        }
        if (listed != before && !again) {
            setSphere(s, spheres++, set);
        }
    }
    pairs.resize(listed);
    resizeSpheres(spheres, set);
    placePairs(pairs, scratch, set);
    return true;
}

// A stable counting sort by leaf and band.
void placePairs(const ListedPairs& pairs, DecideScratch& scratch, ContactSet& set) {
    std::vector<uint32_t>& next = scratch.next;
    constexpr uint32_t kBands = ContactSet::kGapBands;
    const size_t leaves = set.leafCount(), count = pairs.size();
    std::vector<uint32_t>& end = set.pairBandEnd;
    end.assign(leaves * kBands, 0);
    for (size_t k = 0; k < count; ++k) {
        ++end[pairs.bucket[k]];
    }
    next.resize(end.size());
    uint32_t before = 0;
    for (size_t b = 0; b < end.size(); ++b) {
        next[b] = before;
        end[b] = before += end[b];
    }
    set.pairBegin.resize(leaves + 1);
    set.pairBegin[0] = 0;
    for (size_t leaf = 0; leaf < leaves; ++leaf) {
        set.pairBegin[leaf + 1] = end[leaf * kBands + kBands - 1];
    }
    set.pairSphere.resize(count);
    for (size_t k = 0; k < count; ++k) {
        set.pairSphere[next[pairs.bucket[k]]++] = pairs.sphere[k];
    }
    scratch.spheres.resize(set.size());
    for (size_t i = 0; i < set.size(); ++i) { // exact: the values were floats
        scratch.spheres[i] = glm::vec4(set.x[i], set.y[i], set.z[i], set.radius[i]);
    }
    set.pairX.resize(count);
    set.pairY.resize(count);
    set.pairZ.resize(count);
    set.pairRadius.resize(count);
    for (size_t k = 0; k < count; ++k) {
        const glm::vec4& s = scratch.spheres[set.pairSphere[k]];
        set.pairX[k] = s.x;
        set.pairY[k] = s.y;
        set.pairZ[k] = s.z;
        set.pairRadius[k] = s.w;
    }
}

} // namespace fathom
