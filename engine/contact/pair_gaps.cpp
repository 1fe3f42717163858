// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/pair_gaps.h"

#include "engine/contact/clones.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace fathom {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// All by value, so that the compiler knows that writing gaps does not change them.
FATHOM_CLONES
int64_t gapsKernel(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                   const float* __restrict radius, size_t count, double cx, double cy, double cz, double r,
                   double limit, double* __restrict gaps) noexcept {
    int64_t below = 0;
    for (size_t k = 0; k < count; ++k) {
        const double dx = cx - static_cast<double>(x[k]);
        const double dy = cy - static_cast<double>(y[k]);
        const double dz = cz - static_cast<double>(z[k]);
        const double gap = std::sqrt(dx * dx + dy * dy + dz * dz) - (r + static_cast<double>(radius[k]));
        gaps[k] = gap;
        below += gap <= limit ? 1 : 0;
    }
    return below;
}

FATHOM_CLONES
int64_t sweptKernel(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                    const float* __restrict radius, size_t count, double ax, double ay, double az, double bx,
                    double by, double bz, double inverseLength2, double r, double* __restrict gaps) noexcept {
    const double vx = bx - ax, vy = by - ay, vz = bz - az;
    int64_t below = 0;
    for (size_t k = 0; k < count; ++k) {
        const double sx = static_cast<double>(x[k]);
        const double sy = static_cast<double>(y[k]);
        const double sz = static_cast<double>(z[k]);
        const double ux = ax - sx, uy = ay - sy, uz = az - sz;
        const double wx = bx - sx, wy = by - sy, wz = bz - sz;
        const double start = ux * ux + uy * uy + uz * uz;
        const double end = wx * wx + wy * wy + wz * wz;
        // Nearest point of the infinite line. Outside the segment an end is nearer, so t is clamped.
        double t = -(ux * vx + uy * vy + uz * vz) * inverseLength2;
        t = t > 0.0 ? t : 0.0;
        t = t < 1.0 ? t : 1.0;
        const double mx = ux + t * vx, my = uy + t * vy, mz = uz + t * vz;
        double nearest = mx * mx + my * my + mz * mz;
        nearest = t < 1.0 ? nearest : end; // at t = 1 rounding would differ from the distance at the end
        nearest = nearest < end ? nearest : end;
        nearest = nearest < start ? nearest : start;
        const double gap = std::sqrt(nearest) - (r + static_cast<double>(radius[k]));
        gaps[k] = gap;
        below += gap < 0.0 ? 1 : 0;
    }
    return below;
}

FATHOM_CLONES
int64_t coneKernel(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                   size_t count, double cx, double cy, double cz, double nx, double ny, double nz,
                   double cosine2, double keepBelow, double limit, double* __restrict gaps) noexcept {
    int64_t below = 0;
    for (size_t k = 0; k < count; ++k) {
        const double dx = cx - static_cast<double>(x[k]);
        const double dy = cy - static_cast<double>(y[k]);
        const double dz = cz - static_cast<double>(z[k]);
        const double along = dx * nx + dy * ny + dz * nz;
        const double ahead = along > 0.0 ? along : 0.0;
        const bool inside = ahead * ahead >= cosine2 * (dx * dx + dy * dy + dz * dz);
        const double gap = gaps[k];
        const double left = (inside & (gap >= keepBelow)) ? kInfinity : gap;
        gaps[k] = left;
        below += left <= limit ? 1 : 0;
    }
    return below;
}

FATHOM_CLONES
double smallestKernel(const double* __restrict gaps, size_t count) noexcept {
    // Eight running minima fill the widest register; the compiler may not reorder a single one.
    double least[8];
    for (double& l : least) {
        l = kInfinity;
    }
    size_t k = 0;
    for (; k + 8 <= count; k += 8) {
        for (size_t j = 0; j < 8; ++j) {
            least[j] = gaps[k + j] < least[j] ? gaps[k + j] : least[j];
        }
    }
    for (; k < count; ++k) {
        least[0] = gaps[k] < least[0] ? gaps[k] : least[0];
    }
    double smallest = least[0];
    for (size_t j = 1; j < 8; ++j) {
        smallest = least[j] < smallest ? least[j] : smallest;
    }
    return smallest;
}

} // namespace

size_t smallestOf(const double* gaps, size_t count) noexcept {
    const double smallest = smallestKernel(gaps, count);
    size_t at = 0;
    while (at < count && !(gaps[at] == smallest && smallest < kInfinity)) {
        ++at;
    }
    return at;
}

size_t dropCone(const PairArrays& run, const dvec3& centre, const dvec3& axis, double cosine,
                double keepBelow, double limit, double* gaps) noexcept {
    return static_cast<size_t>(coneKernel(run.x, run.y, run.z, run.count, centre.x, centre.y, centre.z,
                                          axis.x, axis.y, axis.z, cosine * cosine, keepBelow, limit, gaps));
}

size_t pairGaps(const PairArrays& run, const dvec3& centre, double leafRadius, double limit,
                double* gaps) noexcept {
    return static_cast<size_t>(gapsKernel(run.x, run.y, run.z, run.radius, run.count, centre.x, centre.y,
                                          centre.z, leafRadius, limit, gaps));
}

size_t sweptGaps(const PairArrays& run, const dvec3& from, const dvec3& to, double leafRadius,
                 double* gaps) noexcept {
    const dvec3 way = to - from;
    const double length2 = glm::dot(way, way);
    const double inverse = length2 > 1e-300 ? 1.0 / length2 : 0.0;
    return static_cast<size_t>(sweptKernel(run.x, run.y, run.z, run.radius, run.count, from.x, from.y, from.z,
                                           to.x, to.y, to.z, inverse, leafRadius, gaps));
}

double gapOf(const PairArrays& run, size_t k, const dvec3& centre, double leafRadius) noexcept {
    const double dx = centre.x - static_cast<double>(run.x[k]);
    const double dy = centre.y - static_cast<double>(run.y[k]);
    const double dz = centre.z - static_cast<double>(run.z[k]);
    return std::sqrt(dx * dx + dy * dy + dz * dz) - (leafRadius + static_cast<double>(run.radius[k]));
}

} // namespace fathom
