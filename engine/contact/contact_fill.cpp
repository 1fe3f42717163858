// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/contact_fill.h"

#include "engine/contact/pair_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom {

namespace {

constexpr double kPairMargin = 1e-9;      // [m] outward
constexpr double kTrustMargin = 8e-6;     // [m] part of the 10 um margin of the trust region
constexpr double kFloatHalfUlp = 0x1p-24; // relative rounding of one float32 operation

void placePairs(size_t leaf, PairScratch& scratch, ContactSet& set) {
    // Stable counting sort by band: within a band the grid's order remains, which depends only on the set.
    std::array<uint32_t, ContactSet::kGapBands> end{};
    for (const double gap : scratch.gap) {
        ++end[set.bandOf(gap)];
    }
    uint32_t sum = set.pairBegin[leaf];
    std::array<uint32_t, ContactSet::kGapBands> next{};
    for (uint32_t band = 0; band < ContactSet::kGapBands; ++band) {
        next[band] = sum;
        sum += end[band];
        set.pairBandEnd[leaf * ContactSet::kGapBands + band] = sum;
    }
    set.pairBegin[leaf + 1] = sum;
    set.pairSphere.resize(sum);
    set.pairX.resize(sum);
    set.pairY.resize(sum);
    set.pairZ.resize(sum);
    set.pairRadius.resize(sum);
    for (size_t k = 0; k < scratch.gap.size(); ++k) {
        const uint32_t at = next[set.bandOf(scratch.gap[k])]++;
        const uint32_t slot = scratch.slot[k];
        set.pairSphere[at] = scratch.grid.order()[slot];
        set.pairX[at] = scratch.grid.x()[slot];
        set.pairY[at] = scratch.grid.y()[slot];
        set.pairZ[at] = scratch.grid.z()[slot];
        set.pairRadius[at] = scratch.grid.radius()[slot];
    }
}

void findPairs(const dvec3& centre, double leafRadius, double limit, PairScratch& scratch) {
    scratch.slot.clear();
    scratch.gap.clear();
    const RegionGrid& grid = scratch.grid;
    const double far = limit + leafRadius + grid.maxRadius() + kPairMargin;
    grid.forEachRun(centre, far, [&](uint32_t begin, uint32_t end) {
        scratch.gaps.resize(std::max<size_t>(scratch.gaps.size(), end - begin));
        const PairArrays run{grid.x().data() + begin, grid.y().data() + begin, grid.z().data() + begin,
                             grid.radius().data() + begin, end - begin};
        if (pairGaps(run, centre, leafRadius, limit, scratch.gaps.data()) == 0) {
            return;
        }
        for (uint32_t k = 0; k < end - begin; ++k) {
            if (scratch.gaps[k] <= limit) {
                scratch.slot.push_back(begin + k);
                scratch.gap.push_back(scratch.gaps[k]);
            }
        }
    });
}

} // namespace

double certifiedReach(const PosedLeaves& leaves, double reach, double maxRegionRadius) noexcept {
    float farthest = 0.0f, largest = 0.0f;
    for (size_t i = 0; i < leaves.x.size(); ++i) {
        farthest = std::max({farthest, std::abs(leaves.x[i]), std::abs(leaves.y[i]), std::abs(leaves.z[i])});
        largest = std::max(largest, leaves.radius[i]);
    }
    // Position: half an ulp per axis. Distance: three roundings in the square count half each, plus one in
    // the difference. Limit: two sums, one product (half of it), three values.
    const double position = std::sqrt(3.0) * kFloatHalfUlp * farthest;
    const double comparison = 8.0 * kFloatHalfUlp * (reach + largest + maxRegionRadius);
    return std::max(0.0, reach - std::max(0.0, position + comparison - kTrustMargin));
}

void sortBySource(const RegionSpheres& spheres, std::vector<uint32_t>& indices, PairScratch& scratch) {
    uint32_t largest = 0;
    scratch.sortKeys.resize(indices.size() * 2);
    scratch.sortValues.resize(indices.size());
    uint32_t* keys = scratch.sortKeys.data();
    uint32_t* keysTo = keys + indices.size();
    for (size_t i = 0; i < indices.size(); ++i) {
        keys[i] = spheres.source[indices[i]];
        largest = std::max(largest, keys[i]);
    }
    constexpr uint32_t kBits = 11;
    std::array<uint32_t, (1u << kBits)> begin;
    for (uint32_t shift = 0; shift < 32 && (largest >> shift) != 0; shift += kBits) {
        begin.fill(0);
        for (size_t i = 0; i < indices.size(); ++i) {
            ++begin[(keys[i] >> shift) & (begin.size() - 1)];
        }
        uint32_t sum = 0;
        for (uint32_t& b : begin) {
            const uint32_t count = b;
            b = sum;
            sum += count;
        }
        for (size_t i = 0; i < indices.size(); ++i) {
            const uint32_t to = begin[(keys[i] >> shift) & (begin.size() - 1)]++;
            scratch.sortValues[to] = indices[i];
            keysTo[to] = keys[i];
        }
        indices.swap(scratch.sortValues);
        std::swap(keys, keysTo);
    }
}

void fillContactSet(const Tool& tool, const Pose& baseTtool, double certified, const Fixtures& fixtures,
                    std::span<const uint32_t> indices, ContactSet& out) {
    out.clear();
    out.frame = fixtures.frame;
    out.generation = fixtures.generation;
    out.captureTime = fixtures.captureTime;
    out.reach = certified;
    out.origin = fixtures.origin;
    out.camera = fixtures.baseTcamera.position - fixtures.origin;
    out.queryPose = baseTtool;
    const RegionSpheres& from = fixtures.spheres;
    const size_t count = indices.size();
    out.x.resize(count), out.y.resize(count), out.z.resize(count), out.radius.resize(count);
    out.source.resize(count), out.fixture.resize(count);
    for (size_t i = 0; i < count; ++i) {
        const uint32_t s = indices[i];
        out.x[i] = from.x[s], out.y[i] = from.y[s], out.z[i] = from.z[s], out.radius[i] = from.radius[s];
        out.source[i] = from.source[s], out.fixture[i] = from.fixture[s];
    }
    const dvec3 centre = baseTtool.position - fixtures.origin;
    out.leafAtQuery.resize(tool.leafCount());
    for (size_t i = 0; i < tool.leafCount(); ++i) {
        out.leafAtQuery.set(i, centre + baseTtool.rotation * tool.leaves()[i].centre);
    }
}

bool listPairs(const Tool& tool, size_t capacity, PairScratch& scratch, ContactSet& set) {
    const size_t count = set.size();
    scratch.x.resize(count), scratch.y.resize(count), scratch.z.resize(count), scratch.radius.resize(count);
    for (size_t i = 0; i < count; ++i) { // exact: the values were floats
        scratch.x[i] = static_cast<float>(set.x[i]);
        scratch.y[i] = static_cast<float>(set.y[i]);
        scratch.z[i] = static_cast<float>(set.z[i]);
        scratch.radius[i] = static_cast<float>(set.radius[i]);
    }
    scratch.grid.build(scratch.x, scratch.y, scratch.z, scratch.radius);
    set.pairSphere.clear();
    set.pairX.clear(), set.pairY.clear(), set.pairZ.clear(), set.pairRadius.clear();
    set.pairBegin.assign(tool.leafCount() + 1, 0);
    set.pairBandEnd.assign(tool.leafCount() * ContactSet::kGapBands, 0);
    for (size_t leaf = 0; leaf < tool.leafCount(); ++leaf) {
        findPairs(set.leafAtQuery[leaf], tool.leaves()[leaf].radius, set.reach + kPairMargin, scratch);
        if (set.pairBegin[leaf] + scratch.slot.size() > capacity) {
            return false;
        }
        placePairs(leaf, scratch, set);
    }
    return true;
}

} // namespace fathom
