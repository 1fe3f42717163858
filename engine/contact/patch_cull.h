// SPDX-License-Identifier: Apache-2.0
// The cull of sparse sets, where a leaf's runs of the grid are too short for vector instructions: walks the
// grid once for a patch of leaves, and tests what it finds against all of them.
#pragma once

#include "engine/contact/region_grid.h"
#include "engine/contact/tool.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// One thread, contact cadence: allocates.
class PatchCull {
public:
    // True where it needs less time than a walk for each leaf: several leaves, and few spheres in their runs.
    static bool isFaster(const PosedLeaves& leaves, float reach, const RegionGrid& grid) noexcept;

    // Sets the mark of each slot of the grid whose sphere CullCpu::cull() finds. marks: by slot, all 0.
    void mark(const PosedLeaves& leaves, float reach, const RegionGrid& grid, std::span<uint8_t> marks);

private:
    static constexpr size_t kPatchLeaves = 32; // successive leaves of a sphere tree are near each other

    // Leaves [begin, end), from their PosedLeaves.
    struct Patch {
        const float *x, *y, *z;
        float limit[kPatchLeaves]; // [m] reach plus radius
        size_t count;
        dvec3 centre;
        double distance; // [m] within which of the centre all spheres lie, but for their own radii
    };
    static Patch patchOf(const PosedLeaves& leaves, size_t begin, float reach) noexcept;
    size_t collect(const Patch& patch, const RegionGrid& grid, std::span<const uint8_t> marks);

    // Spheres near the patch that no earlier patch has found.
    std::vector<float> x_, y_, z_, radius_;
    std::vector<uint32_t> slot_;
    std::vector<int32_t> found_; // not 0: within the limit of a leaf
};

} // namespace fathom
