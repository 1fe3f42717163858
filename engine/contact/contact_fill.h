// SPDX-License-Identifier: Apache-2.0
// Builds a contact set from the list of culled region spheres. The CPU cull and the GPU query share it, so
// that equal lists give equal sets to the last bit.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/region_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Reach that a float32 cull certifies [m]: the requested reach, less the part of the rounding of leaf
// positions, distances and limits that exceeds the trust region's margin (TrustRegion::kMargin). Only leaves
// beyond about 100 m of the origin or regions of tens of metres lose any.
double certifiedReach(const PosedLeaves& leaves, double reach, double maxRegionRadius) noexcept;

// Scratch of the contact cadence, kept to save allocations. One thread.
struct PairScratch {
    RegionGrid grid; // over the culled spheres
    std::vector<float> x, y, z, radius;
    std::vector<double> gaps;   // of one run
    std::vector<uint32_t> slot; // pairs of one leaf in grid order
    std::vector<double> gap;
    std::vector<uint32_t> sortKeys, sortValues;
};

// Sorts indices into `spheres` by source; equal sources keep their order.
void sortBySource(const RegionSpheres& spheres, std::vector<uint32_t>& indices, PairScratch& scratch);

// Fills everything but the pairs and the behind flags: identity of the fixture set, pose, certified reach,
// leaf centres, and the spheres in the order of `indices` (sorted by source). ContactSet::query stays
// as it is.
void fillContactSet(const Tool& tool, const Pose& baseTtool, double certified, const Fixtures& fixtures,
                    std::span<const uint32_t> indices, ContactSet& out);

// Lists every pair of leaf and sphere of `set` whose gap at the query pose, in float64, is at most set.reach
// (and 1 nm more, outward). False, with the pairs left unfinished, when there are more than `capacity`.
bool listPairs(const Tool& tool, size_t capacity, PairScratch& scratch, ContactSet& set);

} // namespace fathom
