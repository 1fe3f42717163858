// SPDX-License-Identifier: Apache-2.0
// Builds a contact set from the list of culled region spheres: what the CPU's query does after its cull.
#pragma once

#include "engine/contact/near_pairs.h"
#include "engine/contact/region_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Scratch of the contact cadence, kept to save allocations. One thread.
struct PairScratch {
    RegionGrid grid; // over the culled spheres
    std::vector<float> x, y, z, radius;
    std::vector<double> gaps; // gaps of one run
    DecideScratch decide;     // its pairs: in the order of the leaves
    ListedPairs ordered;      // the same in the order of the spheres
    std::vector<uint32_t> count;
};

// Fills what does not depend on the spheres found: identity of the fixture set, pose, reach, leaf centres.
// Clears the behind flags. Spheres and pairs stay as they were, because vectors that grow again would write
// zeros first.
void describeQuery(const Tool& tool, const Pose& baseTtool, double reach, const HostFixtures& fixtures,
                   ContactSet& out);

// The same, and the spheres in the order of `indices` (sorted by source).
void fillContactSet(const Tool& tool, const Pose& baseTtool, double reach, const HostFixtures& fixtures,
                    std::span<const uint32_t> indices, ContactSet& out);

// The deciding step for spheres that are already in `set`, sorted by source: lists the same pairs in the same
// order as decidePairs(), and drops spheres without a pair. False, with an incomplete set, when there are
// more than `capacity`.
bool listPairs(const Tool& tool, size_t capacity, PairScratch& scratch, ContactSet& set);

} // namespace fathom
