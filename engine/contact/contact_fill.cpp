// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/contact_fill.h"

#include "engine/contact/pair_gaps.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace fathom {

namespace {

// Appends the leaf's pairs.
void findPairs(uint32_t leaf, double leafRadius, double limit, PairScratch& scratch, const ContactSet& set) {
    ListedPairs& pairs = scratch.decide.pairs;
    const RegionGrid& grid = scratch.grid;
    const dvec3 centre = set.leafAtQuery[leaf];
    const double far = limit + leafRadius + grid.maxRadius() + kPairMargin;
    grid.forEachRun(centre, far, [&](uint32_t begin, uint32_t end) {
        scratch.gaps.resize(std::max<size_t>(scratch.gaps.size(), end - begin));
        if (pairGaps(grid.run(begin, end - begin), {centre, leafRadius}, limit, scratch.gaps.data()) == 0) {
            return;
        }
        for (uint32_t k = 0; k < end - begin; ++k) {
            if (scratch.gaps[k] <= limit) {
                pairs.bucket.push_back(leaf * ContactSet::kGapBands + set.bandOf(scratch.gaps[k]));
                pairs.sphere.push_back(grid.order()[begin + k]);
            }
        }
    });
}

// Puts the pairs in the order of their spheres (a stable counting sort) and drops spheres without a pair.
void orderBySphere(PairScratch& scratch, ContactSet& set) {
    const ListedPairs& pairs = scratch.decide.pairs;
    ListedPairs& ordered = scratch.ordered;
    std::vector<uint32_t>&count = scratch.count, &next = scratch.decide.next;
    count.assign(set.size(), 0);
    for (const uint32_t sphere : pairs.sphere) {
        ++count[sphere];
    }
    next.resize(set.size());
    std::exclusive_scan(count.begin(), count.end(), next.begin(), 0u);
    uint32_t kept = 0;
    for (uint32_t s = 0; s < count.size(); ++s) { // count becomes the new index of the sphere
        if (std::exchange(count[s], kept) != 0) {
            set.x[kept] = set.x[s];
            set.y[kept] = set.y[s];
            set.z[kept] = set.z[s];
            set.radius[kept] = set.radius[s];
            set.source[kept] = set.source[s];
            set.fixture[kept] = set.fixture[s];
            ++kept;
        }
    }
    set.x.resize(kept);
    set.y.resize(kept);
    set.z.resize(kept);
    set.radius.resize(kept);
    set.source.resize(kept);
    set.fixture.resize(kept);
    ordered.resize(pairs.size());
    for (size_t k = 0; k < pairs.size(); ++k) {
        const uint32_t at = next[pairs.sphere[k]]++;
        ordered.bucket[at] = pairs.bucket[k];
        ordered.sphere[at] = count[pairs.sphere[k]];
    }
}

} // namespace

void describeQuery(const Tool& tool, const Pose& baseTtool, double reach, const HostFixtures& fixtures,
                   ContactSet& out) {
    out.behind.clear();
    out.frame = fixtures.frame;
    out.generation = fixtures.generation;
    out.captureTime = fixtures.captureTime;
    out.reach = reach;
    out.origin = fixtures.origin;
    out.camera = fixtures.baseTcamera.position - fixtures.origin;
    const dvec3 centre = baseTtool.position - fixtures.origin;
    out.leafAtQuery.resize(tool.leafCount());
    for (size_t i = 0; i < tool.leafCount(); ++i) {
        out.leafAtQuery.set(i, centre + baseTtool.rotation * tool.leaves()[i].centre);
    }
}

void fillContactSet(const Tool& tool, const Pose& baseTtool, double reach, const HostFixtures& fixtures,
                    std::span<const uint32_t> indices, ContactSet& out) {
    describeQuery(tool, baseTtool, reach, fixtures, out);
    const RegionSpheres& from = fixtures.spheres;
    const size_t count = indices.size();
    out.x.resize(count);
    out.y.resize(count);
    out.z.resize(count);
    out.radius.resize(count);
    out.source.resize(count);
    out.fixture.resize(count);
    for (size_t i = 0; i < count; ++i) {
        const uint32_t s = indices[i];
        out.x[i] = from.x[s];
        out.y[i] = from.y[s];
        out.z[i] = from.z[s];
        out.radius[i] = from.radius[s];
        out.source[i] = from.source[s];
        out.fixture[i] = from.fixture[s];
    }
}

bool listPairs(const Tool& tool, size_t capacity, PairScratch& scratch, ContactSet& set) {
    const size_t count = set.size();
    scratch.x.resize(count);
    scratch.y.resize(count);
    scratch.z.resize(count);
    scratch.radius.resize(count);
    for (size_t i = 0; i < count; ++i) { // exact: the values were floats
        scratch.x[i] = static_cast<float>(set.x[i]);
        scratch.y[i] = static_cast<float>(set.y[i]);
        scratch.z[i] = static_cast<float>(set.z[i]);
        scratch.radius[i] = static_cast<float>(set.radius[i]);
    }
    scratch.grid.build(scratch.x, scratch.y, scratch.z, scratch.radius);
    scratch.decide.pairs.clear();
    for (uint32_t leaf = 0; leaf < tool.leafCount(); ++leaf) {
        findPairs(leaf, tool.leaves()[leaf].radius, set.reach + kPairMargin, scratch, set);
        if (scratch.decide.pairs.size() > capacity) {
            return false;
        }
    }
    orderBySphere(scratch, set);
    placePairs(scratch.ordered, scratch.decide, set);
    return true;
}

} // namespace fathom
