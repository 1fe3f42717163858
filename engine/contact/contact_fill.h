// SPDX-License-Identifier: Apache-2.0
// Builds a contact set from the list of culled region spheres. The CPU cull and the GPU query share it, so
// equal lists give identical sets.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/region_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Reach [m] that a float32 cull certifies: the requested reach minus the rounding of leaf positions,
// distances and limits that exceeds TrustRegion::kMargin. Differs only for leaves beyond about 100 m from the
// origin or regions of tens of metres.
double certifiedReach(const PosedLeaves& leaves, double reach, double maxRegionRadius) noexcept;

// Scratch of the contact cadence, kept to save allocations. One thread.
struct PairScratch {
    RegionGrid grid; // over the culled spheres
    std::vector<float> x, y, z, radius;
    std::vector<double> gaps;   // gaps of one run
    std::vector<uint32_t> slot; // the pairs of one leaf in grid order
    std::vector<double> gap;
    std::vector<uint32_t> sortKeys, sortValues;
};

// Sorts indices into `spheres` by source; equal sources keep their order.
void sortBySource(const RegionSpheres& spheres, std::vector<uint32_t>& indices, PairScratch& scratch);

// Fills everything except the pairs, the behind flags and ContactSet::query: identity of the fixture set,
// pose, certified reach, leaf centres, and the spheres in the order of `indices` (sorted by source).
void fillContactSet(const Tool& tool, const Pose& baseTtool, double certified, const Fixtures& fixtures,
                    std::span<const uint32_t> indices, ContactSet& out);

// Lists every pair of leaf and sphere of `set` whose gap at the query pose, in float64, is at most set.reach
// (plus 1 nm of margin). False, with incomplete pairs, when there are more than `capacity`.
bool listPairs(const Tool& tool, size_t capacity, PairScratch& scratch, ContactSet& set);

} // namespace fathom
