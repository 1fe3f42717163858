// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/nearest_spheres.h"

#include "engine/contact/clones.h"
#include "engine/contact/sphere_span.h"

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
uint32_t anyWithin(SphereSpan run, glm::vec3 leaf, float far) noexcept {
    uint32_t any = 0;
    for (size_t k = 0; k < run.count; ++k) {
        const float dx = leaf.x - run.x[k], dy = leaf.y - run.y[k], dz = leaf.z - run.z[k];
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
uint32_t mayReach(SphereSpan run, glm::vec3 leaf, float r, float limit) noexcept {
    uint32_t any = 0;
    for (size_t k = 0; k < run.count; ++k) {
        const float dx = leaf.x - run.x[k], dy = leaf.y - run.y[k], dz = leaf.z - run.z[k];
        const float far = reachOf(limit, r, run.radius[k]);
        any |= dx * dx + dy * dy + dz * dz <= far * far ? 1u : 0u;
    }
    return any;
}

// slot: slot of the run's first sphere.
FATHOM_CLONES
void nearestKernel(SphereSpan run, uint32_t slot, glm::vec3 leaf, float r,
                   Minima& __restrict minima) noexcept {
    for (size_t k = 0; k < run.count; k += kMinima) {
        for (uint32_t j = 0; j < kMinima; ++j) {
            const float dx = leaf.x - run.x[k + j], dy = leaf.y - run.y[k + j], dz = leaf.z - run.z[k + j];
            const float gap = std::sqrt(dx * dx + dy * dy + dz * dz) - (r + run.radius[k + j]);
            const bool nearer = gap < minima.gap[j];
            minima.gap[j] = nearer ? gap : minima.gap[j];
            minima.slot[j] = nearer ? slot + static_cast<uint32_t>(k) + j : minima.slot[j];
        }
    }
}

// Scalar version of the kernel, for the slots at the end of the arrays.
void nearestOfFew(const RegionGrid& grid, uint32_t begin, uint32_t end, const glm::vec3& leaf, float r,
                  Minima& minima) noexcept {
    for (uint32_t k = begin; k < end; ++k) {
        const float dx = leaf.x - grid.x()[k], dy = leaf.y - grid.y()[k], dz = leaf.z - grid.z()[k];
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
        const glm::vec3 leaf = leaves.centre(i);
        bool any = false;
        float least = limit; // [m] farther spheres are skipped
        grid.forEachRun(dvec3(leaf), far, [&](uint32_t begin, uint32_t end) {
            // The last step also tests slots beyond the run, which are valid spheres of the set.
            const uint32_t steps = std::min((end - begin + kMinima - 1) / kMinima, (slots - begin) / kMinima);
            const uint32_t whole = steps * kMinima;
            const SphereSpan all = grid.run(begin, std::max(whole, end - begin));
            if (anyWithin(all, leaf, reachOf(least, r, static_cast<float>(grid.maxRadius()))) == 0 ||
                mayReach(all, leaf, r, least) == 0) {
                return;
            }
            if (!any) {
                minima.gap.fill(std::numeric_limits<float>::infinity());
                minima.slot.fill(NearestSphere::kNone);
                any = true;
            }
            nearestKernel(grid.run(begin, whole), begin, leaf, r, minima);
            nearestOfFew(grid, begin + whole, end, leaf, r, minima);
            least = std::min(least, *std::min_element(minima.gap.begin(), minima.gap.end()));
        });
        out[i] = any ? smallestOfMinima(minima, limit, grid) : NearestSphere{};
    }
}

} // namespace fathom
