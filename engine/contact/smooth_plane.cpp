// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/smooth_plane.h"

#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr double kLeastNormal = 0.5; // a shorter mean normal is no direction
constexpr double kRounding = 1e-15;  // [m] of a bend that is not negative

// Mean normal of the spheres of the patch, weighted so that a sphere enters with weight 0. Writes their
// indices to `patch` and returns their number; 0 when there are too many.
size_t gatherPatch(const PairArrays& run, const dvec3& centre, double leafRadius, double nearest,
                   double depth, std::span<uint32_t> patch, dvec3& normal) noexcept {
    size_t count = 0;
    dvec3 sum(0.0);
    double weights = 0.0;
    for (size_t k = 0; k < run.count; ++k) {
        const dvec3 delta = awayFrom(run, k, centre);
        const double touch = leafRadius + static_cast<double>(run.radius[k]),
                     farthest = touch + nearest + depth;
        const double square = glm::dot(delta, delta);
        if (!(square < farthest * farthest)) {
            continue;
        }
        if (count == patch.size()) {
            return 0;
        }
        patch[count++] = static_cast<uint32_t>(k);
        const double length = std::sqrt(square), share = 1.0 - (length - touch - nearest) / depth;
        const double weight = share * share;
        sum += (weight / length) * delta;
        weights += weight;
    }
    const double length = glm::length(sum);
    normal = sum / length;
    return length > kLeastNormal * weights ? count : 0;
}

} // namespace

bool smoothPlane(const PairArrays& run, const dvec3& centre, double leafRadius, double nearest, double depth,
                 std::span<uint32_t> scratch, SmoothPlane& plane) noexcept {
    const size_t count = gatherPatch(run, centre, leafRadius, nearest, depth, scratch, plane.normal);
    plane.gap = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < count; ++i) {
        const size_t k = scratch[i];
        const dvec3 delta = awayFrom(run, k, centre);
        const double touch = leafRadius + static_cast<double>(run.radius[k]);
        const double height = glm::dot(plane.normal, delta);
        if (height - touch > plane.gap + kRounding) { // the bend only raises it
            continue;
        }
        const double aside = glm::dot(delta, delta) - height * height, patch = 2.0 * touch * depth;
        if (aside < patch) {
            const double bend = 0.5 * kBend / touch * aside / (1.0 - aside / patch);
            plane.gap = std::min(plane.gap, height - touch + bend);
        }
    }
    return plane.gap < nearest;
}

} // namespace fathom
