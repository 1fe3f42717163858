// SPDX-License-Identifier: Apache-2.0
// The contact query on the CPU: finds every region sphere within reach of a tool leaf in the fixture set's
// grid.
#pragma once

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

    // Fills `out` with every sphere with d^2 <= (reach + r_t + R)^2 for some leaf, sorted by source, and with
    // all pairs. Computed in float32 on the values of poseLeaves(), d^2 = dx dx + dy dy + dz dz left to right
    // without contraction. `grid` must have been built from `fixtures`. Overflow: see QueryLoop::run.
    void query(const Tool& tool, const Pose& baseTtool, double reach, const Fixtures& fixtures,
               const RegionGrid& grid, ContactSet& out);

    // Only the first step of query(): the index of every such sphere, once, in grid order.
    // leaves: poseLeaves() about the set's origin.
    void cull(const PosedLeaves& leaves, float reach, const RegionGrid& grid, std::vector<uint32_t>& found);

    const QueryStatistics& statistics() const { return loop_.statistics(); }
    const QueryCapacity& capacity() const { return loop_.capacity(); }

private:
    QueryLoop loop_;
    std::vector<uint8_t> marks_; // by slot of the grid
};

} // namespace fathom
