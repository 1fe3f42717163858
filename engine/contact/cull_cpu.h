// SPDX-License-Identifier: Apache-2.0
// The contact query on the CPU: finds every region sphere within reach of a tool leaf in the fixture set's
// grid.
#pragma once

#include "engine/contact/contact_fill.h"
#include "engine/contact/patch_cull.h"
#include "engine/contact/query_loop.h"
#include "engine/contact/region_grid.h"

#include <cstdint>
#include <vector>

namespace fathom {

// One thread, contact cadence: allocates.
class CullCpu {
public:
    explicit CullCpu(const QueryCapacity& capacity = {})
        : loop_(capacity) {}

    // Fills `out` with every pair of leaf and sphere whose gap is at most `reach`, as decidePairs() defines
    // it. `grid` must have been built from `fixtures`. Overflow: see QueryLoop::run.
    void query(const Tool& tool, const Pose& baseTtool, double reach, const HostFixtures& fixtures,
               const RegionGrid& grid, ContactSet& out);

    // Only the first step of query(): the index of every sphere with d^2 <= (reach + r_t + R)^2 for some
    // leaf, once, in grid order. In float32 with the order of operations of exactGap(). leaves: poseLeaves()
    // about the set's origin.
    void cull(const PosedLeaves& leaves, float reach, const RegionGrid& grid, std::vector<uint32_t>& found);

    const QueryStatistics& statistics() const { return loop_.statistics(); }
    const QueryCapacity& capacity() const { return loop_.capacity(); }

private:
    void markByLeaf(const PosedLeaves& leaves, float reach, const RegionGrid& grid);

    QueryLoop loop_;
    PatchCull patches_;
    PosedLeaves leaves_;
    std::vector<uint32_t> found_;
    PairScratch scratch_;
    std::vector<uint8_t> marks_; // by slot of the grid
};

} // namespace fathom
