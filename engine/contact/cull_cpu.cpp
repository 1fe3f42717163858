// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/cull_cpu.h"

#include "engine/contact/clones.h"
#include "engine/contact/sphere_span.h"

#include <algorithm>
#include <cstring>

namespace fathom {

namespace {

constexpr uint32_t kBlock = 32; // slots per kernel step (marks are bytes)
constexpr uint32_t kFew = 5;    // up to this many slots a scalar loop is faster

// limit [m]: reach plus the leaf's radius.
FATHOM_CLONES
void markKernel(SphereSpan run, glm::vec3 leaf, float limit, uint8_t* __restrict marks) noexcept {
    for (size_t k = 0; k < run.count; ++k) {
        const float dx = leaf.x - run.x[k], dy = leaf.y - run.y[k], dz = leaf.z - run.z[k];
        const float far = limit + run.radius[k];
        marks[k] |= static_cast<uint8_t>(dx * dx + dy * dy + dz * dz <= far * far ? 1 : 0);
    }
}

// Grid runs are short, and a scalar remainder loop is six times slower. So the last step also tests slots
// beyond the run. This is exact, because a slot's mark does not depend on the run.
uint32_t wholeSteps(uint32_t begin, uint32_t end, uint32_t slots) noexcept {
    const uint32_t count = end - begin;
    return count <= kFew ? count : std::min((count + kBlock - 1) / kBlock * kBlock, slots - begin);
}

} // namespace

void CullCpu::markByLeaf(const PosedLeaves& leaves, float reach, const RegionGrid& grid) {
    const auto slots = static_cast<uint32_t>(grid.size());
    for (size_t i = 0; i < leaves.x.size(); ++i) {
        const float limit = reach + leaves.radius[i];
        // The grid query is in float64, with a box wider than any float32 rounding.
        const double far = (static_cast<double>(limit) + grid.maxRadius()) * (1.0 + 1e-5) + 1e-9;
        const glm::vec3 centre = leaves.centre(i);
        grid.forEachRun(dvec3(centre), far, [&](uint32_t begin, uint32_t end) {
            markKernel(grid.run(begin, wholeSteps(begin, end, slots)), centre, limit, marks_.data() + begin);
        });
    }
}

void CullCpu::cull(const PosedLeaves& leaves, float reach, const RegionGrid& grid,
                   std::vector<uint32_t>& found) {
    marks_.assign((grid.size() + 7) / 8 * 8, 0);
    if (PatchCull::isFaster(leaves, reach, grid)) {
        patches_.mark(leaves, reach, grid, marks_);
    } else {
        markByLeaf(leaves, reach, grid);
    }
    found.clear();
    for (size_t slot = 0; slot < marks_.size(); slot += 8) {
        uint64_t eight = 0;
        std::memcpy(&eight, marks_.data() + slot, 8);
        for (size_t k = 0; eight != 0; eight >>= 8, ++k) {
            if ((eight & 1) != 0) {
                found.push_back(grid.order()[slot + k]);
            }
        }
    }
}

void CullCpu::query(const Tool& tool, const Pose& baseTtool, double reach, const HostFixtures& fixtures,
                    const RegionGrid& grid, ContactSet& out) {
    poseLeaves(tool, baseTtool, fixtures.origin, leaves_);
    const auto onGrid = [&](double tried, const QueryCapacity& most, ContactSet& set) {
        const double away = glm::distance(baseTtool.position, fixtures.origin);
        cull(leaves_, outwardReach(tool.boundingRadius(), away, tried, grid.maxRadius()), grid, found_);
        std::vector<uint32_t>& sources = scratch_.decide.sort.keys;
        sources.resize(found_.size());
        std::ranges::transform(found_, sources.begin(),
                               [&](uint32_t i) { return fixtures.spheres.source[i]; });
        sortBySource(found_, scratch_.decide.sort);
        fillContactSet(tool, baseTtool, tried, fixtures, found_, set);
        return listPairs(tool, most.pairs, scratch_, set);
    };
    loop_.run(reach, onGrid, out);
}

} // namespace fathom
