// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/nearest_spheres.h"

#include "engine/contact/clones.h"

#include <algorithm>
#include <array>

namespace fathom {

namespace {

constexpr uint32_t kMinima = 16; // lanes of the widest register, each with its own minimum

struct Minima {
    alignas(64) std::array<float, kMinima> gap;
    alignas(64) std::array<uint32_t, kMinima> slot;
};

// True if a centre of the run is within `far` [m]. Cheaper than mayReach(), and most runs have no centre
// within the largest sphere's reach.
FATHOM_CLONES
uint32_t anyWithin(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                   uint32_t count, float cx, float cy, float cz, float far) noexcept {
    uint32_t any = 0;
    for (uint32_t k = 0; k < count; ++k) {
        const float dx = cx - x[k], dy = cy - y[k], dz = cz - z[k];
        any |= dx * dx + dy * dy + dz * dz <= far * far ? 1u : 0u;
    }
    return any;
}

// Largest distance between a leaf of radius r and a sphere of the given radius with a gap up to `limit`. The
// slack exceeds the rounding of the exact gap.
inline float reachOf(float limit, float r, float radius) noexcept {
    const float wide = (limit + (r + radius)) * 1.00001f + 1e-6f;
    return wide > 0.0f ? wide : 0.0f;
}

// True if a sphere of the run can have a gap up to `limit`; never misses one. Most runs have none and need no
// square root.
FATHOM_CLONES
uint32_t mayReach(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                  const float* __restrict radius, uint32_t count, float cx, float cy, float cz, float r,
                  float limit) noexcept {
    uint32_t any = 0;
    for (uint32_t k = 0; k < count; ++k) {
        const float dx = cx - x[k], dy = cy - y[k], dz = cz - z[k];
        const float far = reachOf(limit, r, radius[k]);
        any |= dx * dx + dy * dy + dz * dz <= far * far ? 1u : 0u;
    }
    return any;
}

// slot: slot of the run's first sphere.
FATHOM_CLONES
void nearestKernel(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                   const float* __restrict radius, uint32_t slot, uint32_t count, float cx, float cy,
                   float cz, float r, float* __restrict least, uint32_t* __restrict at) noexcept {
    for (uint32_t k = 0; k < count; k += kMinima) {
        for (uint32_t j = 0; j < kMinima; ++j) {
            const float dx = cx - x[k + j], dy = cy - y[k + j], dz = cz - z[k + j];
            const float gap = std::sqrt(dx * dx + dy * dy + dz * dz) - (r + radius[k + j]);
            const bool nearer = gap < least[j];
            least[j] = nearer ? gap : least[j];
            at[j] = nearer ? slot + k + j : at[j];
        }
    }
}

// Scalar version of the kernel, for the slots at the end of the arrays.
void nearestOfFew(const RegionGrid& grid, uint32_t begin, uint32_t end, const dvec3& centre, float r,
                  Minima& minima) noexcept {
    const auto cx = static_cast<float>(centre.x), cy = static_cast<float>(centre.y),
               cz = static_cast<float>(centre.z);
    for (uint32_t k = begin; k < end; ++k) {
        const float dx = cx - grid.x()[k], dy = cy - grid.y()[k], dz = cz - grid.z()[k];
        const float gap = std::sqrt(dx * dx + dy * dy + dz * dz) - (r + grid.radius()[k]);
        if (gap < minima.gap[0]) {
            minima.gap[0] = gap;
            minima.slot[0] = k;
        }
    }
}

NearestSphere smallestOfMinima(const Minima& minima, float limit, const RegionGrid& grid) noexcept {
    uint32_t best = 0;
    for (uint32_t j = 1; j < kMinima; ++j) {
        const bool nearer = minima.gap[j] < minima.gap[best] ||
                            (minima.gap[j] == minima.gap[best] && minima.slot[j] < minima.slot[best]);
        best = nearer ? j : best;
    }
    const bool any = minima.slot[best] != NearestSphere::kNone && minima.gap[best] <= limit;
    return any ? NearestSphere{grid.order()[minima.slot[best]], minima.gap[best]} : NearestSphere{};
}

} // namespace

void nearestSpheres(const PosedLeaves& leaves, float limit, const RegionGrid& grid,
                    std::vector<NearestSphere>& out) {
    const auto slots = static_cast<uint32_t>(grid.size());
    out.resize(leaves.x.size());
    Minima minima;
    for (size_t i = 0; i < leaves.x.size(); ++i) {
        const float r = leaves.radius[i];
        // The grid query is in float64, with a box wider than any float32 rounding.
        const double far =
            (static_cast<double>(limit) + static_cast<double>(r) + grid.maxRadius()) * (1.0 + 1e-5) + 1e-9;
        const dvec3 centre(leaves.x[i], leaves.y[i], leaves.z[i]);
        bool any = false;
        float least = limit; // [m] farther spheres are skipped
        grid.forEachRun(centre, far, [&](uint32_t begin, uint32_t end) {
            // The last step also tests slots beyond the run, which are valid spheres of the set.
            const uint32_t steps = std::min((end - begin + kMinima - 1) / kMinima, (slots - begin) / kMinima);
            const uint32_t whole = steps * kMinima;
            const float *x = grid.x().data() + begin, *y = grid.y().data() + begin,
                        *z = grid.z().data() + begin, *radius = grid.radius().data() + begin;
            const uint32_t count = std::max(whole, end - begin);
            if (anyWithin(x, y, z, count, leaves.x[i], leaves.y[i], leaves.z[i],
                          reachOf(least, r, static_cast<float>(grid.maxRadius()))) == 0 ||
                mayReach(x, y, z, radius, count, leaves.x[i], leaves.y[i], leaves.z[i], r, least) == 0) {
                return;
            }
            if (!any) {
                minima.gap.fill(std::numeric_limits<float>::infinity());
                minima.slot.fill(NearestSphere::kNone);
                any = true;
            }
            nearestKernel(x, y, z, radius, begin, whole, leaves.x[i], leaves.y[i], leaves.z[i], r,
                          minima.gap.data(), minima.slot.data());
            nearestOfFew(grid, begin + whole, end, centre, r, minima);
            least = std::min(least, *std::min_element(minima.gap.begin(), minima.gap.end()));
        });
        out[i] = any ? smallestOfMinima(minima, limit, grid) : NearestSphere{};
    }
}

} // namespace fathom
