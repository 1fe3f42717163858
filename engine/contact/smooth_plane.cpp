// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/smooth_plane.h"

#include "engine/contact/clones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr double kOffPlane = std::numeric_limits<double>::infinity();
constexpr double kMinNormal = 0.5;  // a shorter mean normal is no direction
constexpr double kRounding = 1e-15; // [m] of a bend that is not negative
constexpr double kAgree = 10.0;     // 1 / rise of the cosine to full weight, for spheres like the nearest

// Spheres of a run that are processed together.
struct PatchBlock {
    static constexpr size_t kSize = 128;
    alignas(64) std::array<double, kSize> x, y, z, weight;
};

// Weighted directions from the spheres to the leaf, zero for spheres that are not in the patch. nearest: of
// the nearest sphere. agree [1/m]: how fast the weight grows away from kOtherSurface and kOpposite.
FATHOM_CLONES
void weighKernel(SphereSpan run, Sphere leaf, SmoothPlane nearest, double depth, double agree,
                 PatchBlock& block) noexcept {
    const dvec3 c = leaf.centre, n = nearest.normal;
    for (size_t k = 0; k < run.count; ++k) {
        const double dx = c.x - static_cast<double>(run.x[k]);
        const double dy = c.y - static_cast<double>(run.y[k]);
        const double dz = c.z - static_cast<double>(run.z[k]);
        const double touch = leaf.radius + static_cast<double>(run.radius[k]);
        const double farthest = touch + nearest.gap + depth;
        const double square = dx * dx + dy * dy + dz * dz;
        const double inside =
            square < farthest * farthest ? 1.0 : 0.0; // a factor, because branches do not vectorise
        const double length = std::sqrt(square), share = 1.0 - (length - touch - nearest.gap) / depth;
        const double along = n.x * dx + n.y * dy + n.z * dz;
        const double counts = std::max(along - kOtherSurface * length, kOpposite * length - along) * agree;
        const double part = std::min(1.0, std::max(0.0, counts)); // no rounding where that is 1
        const double weight = share * share * inside * part, scale = weight / length;
        block.x[k] = scale * dx;
        block.y[k] = scale * dy;
        block.z[k] = scale * dz;
        block.weight[k] = weight;
    }
}

// Height of the leaf's centre over the tangent of each sphere of the patch that is parallel to the plane with
// this normal; infinity for the others. nearest [m]: gap of the nearest sphere.
FATHOM_CLONES
void heightKernel(SphereSpan run, Sphere leaf, double nearest, dvec3 normal, double depth,
                  double* __restrict heights) noexcept {
    for (size_t k = 0; k < run.count; ++k) {
        const double dx = leaf.centre.x - static_cast<double>(run.x[k]);
        const double dy = leaf.centre.y - static_cast<double>(run.y[k]);
        const double dz = leaf.centre.z - static_cast<double>(run.z[k]);
        const double touch = leaf.radius + static_cast<double>(run.radius[k]);
        const double farthest = touch + nearest + depth;
        const double square = dx * dx + dy * dy + dz * dz;
        const double outside = square < farthest * farthest ? 0.0 : kOffPlane;
        heights[k] = normal.x * dx + normal.y * dy + normal.z * dz - touch + outside;
    }
}

// Mean normal of the spheres of the patch, weighted so that a sphere enters with weight 0. False when it is
// no direction, and when a sphere that counts is nearer.
bool meanNormal(const SphereSpan& run, const Sphere& leaf, const SmoothPlane& nearest, double depth,
                double agree, dvec3& normal) noexcept {
    dvec3 sum(0.0);
    double weights = 0.0, most = 0.0;
    for (size_t begin = 0; begin < run.count; begin += PatchBlock::kSize) {
        PatchBlock block;
        const SphereSpan some = part(run, begin, PatchBlock::kSize);
        weighKernel(some, leaf, nearest, depth, agree, block);
        for (size_t k = 0; k < some.count; ++k) {
            sum += dvec3(block.x[k], block.y[k], block.z[k]);
            weights += block.weight[k];
            most = std::max(most, block.weight[k]); // 1 without rounding for the nearest sphere
        }
    }
    const double length = glm::length(sum);
    normal = sum / length;
    return length > kMinNormal * weights && most <= 1.0;
}

} // namespace

bool smoothPlane(const SphereSpan& run, const Sphere& leaf, const SmoothPlane& nearest, double depth,
                 SmoothPlane& plane) noexcept {
    const double agree = 0.5 * kAgree * kPatch * kPatch / depth; // kAgree / (R + r) of the nearest, or more
    if (!meanNormal(run, leaf, nearest, depth, agree, plane.normal)) {
        return false;
    }
    plane.gap = kOffPlane;
    for (size_t begin = 0; begin < run.count; begin += PatchBlock::kSize) {
        alignas(64) std::array<double, PatchBlock::kSize> heights;
        const SphereSpan some = part(run, begin, PatchBlock::kSize);
        heightKernel(some, leaf, nearest.gap, plane.normal, depth, heights.data());
        for (size_t k = 0; k < some.count; ++k) {
            if (heights[k] > plane.gap + kRounding || !(heights[k] < kOffPlane)) {
                continue; // the bend only raises it
            }
            const dvec3 delta = awayFrom(some, k, leaf.centre);
            const double touch = leaf.radius + static_cast<double>(some.radius[k]);
            const double height = glm::dot(plane.normal, delta);
            const double aside = glm::dot(delta, delta) - height * height, patch = 2.0 * touch * depth;
            if (aside < patch) {
                const double bend = 0.5 * kBend / touch * aside / (1.0 - aside / patch);
                plane.gap = std::min(plane.gap, height - touch + bend);
            }
        }
    }
    return plane.gap < nearest.gap;
}

} // namespace fathom
