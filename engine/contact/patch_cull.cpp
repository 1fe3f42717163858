// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/patch_cull.h"

#include "engine/contact/clones.h"
#include "engine/contact/sphere_span.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace fathom {

namespace {

constexpr size_t kPatchLanes = 16; // spheres per step
constexpr size_t kFewestLeaves = 8;
constexpr double kShortRun = 8.0; // spheres; with longer runs a walk for each leaf is as fast
using SphereLanes = float __attribute__((vector_size(4 * kPatchLanes)));
using FoundLanes = int32_t __attribute__((vector_size(4 * kPatchLanes)));

// The arithmetic of CullCpu::cull(). Steps are whole: the arrays have kPatchLanes - 1 more elements. leaves:
// limits in the place of radii.
FATHOM_CLONES
void findKernel(SphereSpan run, SphereSpan leaves, int32_t* __restrict found) noexcept {
    for (size_t k = 0; k < run.count; k += kPatchLanes) {
        SphereLanes sx, sy, sz, sr;
        std::memcpy(&sx, run.x + k, sizeof sx);
        std::memcpy(&sy, run.y + k, sizeof sy);
        std::memcpy(&sz, run.z + k, sizeof sz);
        std::memcpy(&sr, run.radius + k, sizeof sr);
        FoundLanes any{};
        for (size_t l = 0; l < leaves.count; ++l) {
            const SphereLanes dx = leaves.x[l] - sx, dy = leaves.y[l] - sy, dz = leaves.z[l] - sz;
            const SphereLanes far = leaves.radius[l] + sr;
            any |= dx * dx + dy * dy + dz * dz <= far * far;
        }
        std::memcpy(found + k, &any, sizeof any);
    }
}

} // namespace

bool PatchCull::isFaster(const PosedLeaves& leaves, float reach, const RegionGrid& grid) noexcept {
    if (leaves.x.size() < kFewestLeaves) {
        return false;
    }
    const double far = static_cast<double>(reach + leaves.radius.front()) + grid.maxRadius();
    constexpr double kMeanChord = 4.0 / 3.0; // of a ball, in radii
    return grid.spheresPerMetre() * kMeanChord * far < kShortRun;
}

PatchCull::Patch PatchCull::patchOf(const PosedLeaves& leaves, size_t begin, float reach) noexcept {
    Patch patch{};
    patch.x = leaves.x.data() + begin;
    patch.y = leaves.y.data() + begin;
    patch.z = leaves.z.data() + begin;
    patch.count = std::min(kPatchLeaves, leaves.x.size() - begin);
    dvec3 lo(std::numeric_limits<double>::infinity()), hi(-lo);
    for (size_t l = 0; l < patch.count; ++l) {
        const dvec3 leaf(patch.x[l], patch.y[l], patch.z[l]);
        lo = glm::min(lo, leaf);
        hi = glm::max(hi, leaf);
        patch.limit[l] = reach + leaves.radius[begin + l];
    }
    patch.centre = 0.5 * (lo + hi);
    for (size_t l = 0; l < patch.count; ++l) {
        const double away = glm::distance(dvec3(patch.x[l], patch.y[l], patch.z[l]), patch.centre);
        patch.distance = std::max(patch.distance, away + static_cast<double>(patch.limit[l]));
    }
    return patch;
}

// Returns how many.
size_t PatchCull::collect(const Patch& patch, const RegionGrid& grid, std::span<const uint8_t> marks) {
    // In float64, with a box wider than any float32 rounding, as for a leaf.
    const double far = (patch.distance + grid.maxRadius()) * (1.0 + 1e-5) + 1e-9;
    size_t count = 0;
    grid.forEachRun(patch.centre, far, [&](uint32_t begin, uint32_t end) {
        const size_t most = count + (end - begin) + kPatchLanes;
        if (most > x_.size()) {
            for (std::vector<float>* column : {&x_, &y_, &z_, &radius_}) {
                column->resize(2 * most);
            }
            slot_.resize(2 * most);
            found_.resize(2 * most);
        }
        for (uint32_t slot = begin; slot < end; ++slot) {
            x_[count] = grid.x()[slot];
            y_[count] = grid.y()[slot];
            z_[count] = grid.z()[slot];
            radius_[count] = grid.radius()[slot];
            slot_[count] = slot;
            count += marks[slot] == 0 ? 1 : 0;
        }
    });
    return count;
}

void PatchCull::mark(const PosedLeaves& leaves, float reach, const RegionGrid& grid,
                     std::span<uint8_t> marks) {
    for (size_t begin = 0; begin < leaves.x.size(); begin += kPatchLeaves) {
        const Patch patch = patchOf(leaves, begin, reach);
        const size_t count = collect(patch, grid, marks);
        findKernel({x_.data(), y_.data(), z_.data(), radius_.data(), count},
                   {patch.x, patch.y, patch.z, patch.limit, patch.count}, found_.data());
        for (size_t k = 0; k < count; ++k) {
            marks[slot_[k]] = found_[k] != 0 ? 1 : 0;
        }
    }
}

} // namespace fathom
