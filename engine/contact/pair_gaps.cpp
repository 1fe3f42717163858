// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/pair_gaps.h"

#include "engine/contact/clones.h"
#include "engine/contact/exact_gap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace fathom {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr size_t kGapLanes = 8; // lanes of the widest register
using GapLanes = double __attribute__((vector_size(8 * kGapLanes)));
constexpr size_t kGapBlock = 256; // gaps per step of a search

// Spans, leaves and vectors are passed by value, so that no store to gaps can change them.
FATHOM_CLONES
int64_t gapsKernel(SphereSpan run, Sphere leaf, double limit, double* __restrict gaps) noexcept {
    int64_t below = 0;
    for (size_t k = 0; k < run.count; ++k) {
        const double gap = exactGap(leaf, run.x[k], run.y[k], run.z[k], run.radius[k]);
        gaps[k] = gap;
        below += gap <= limit ? 1 : 0;
    }
    return below;
}

FATHOM_CLONES
void memberKernel(SphereSpan run, Sphere leaf, double members, double* __restrict gaps) noexcept {
    for (size_t k = 0; k < run.count; ++k) {
        const double gap = exactGap(leaf, run.x[k], run.y[k], run.z[k], run.radius[k]);
        const double others = gaps[k] <= members ? 0.0 : kInfinity;
        gaps[k] = gap + others;
    }
}

// r: radius of the leaf that moves from a to b.
FATHOM_CLONES
int64_t sweptKernel(SphereSpan run, dvec3 a, dvec3 b, double inverseLength2, double r,
                    double* __restrict gaps) noexcept {
    const dvec3 v = b - a;
    int64_t below = 0;
    for (size_t k = 0; k < run.count; ++k) {
        const double sx = static_cast<double>(run.x[k]);
        const double sy = static_cast<double>(run.y[k]);
        const double sz = static_cast<double>(run.z[k]);
        const double ux = a.x - sx, uy = a.y - sy, uz = a.z - sz;
        const double wx = b.x - sx, wy = b.y - sy, wz = b.z - sz;
        const double start = ux * ux + uy * uy + uz * uz;
        const double end = wx * wx + wy * wy + wz * wz;
        // Nearest point of the infinite line. Outside the segment an end is nearer, so t is clamped.
        double t = -(ux * v.x + uy * v.y + uz * v.z) * inverseLength2;
        t = t > 0.0 ? t : 0.0;
        t = t < 1.0 ? t : 1.0;
        const double mx = ux + t * v.x, my = uy + t * v.y, mz = uz + t * v.z;
        double nearest = mx * mx + my * my + mz * mz;
        nearest = t < 1.0 ? nearest : end; // at t = 1 rounding would differ from the distance at the end
        nearest = nearest < end ? nearest : end;
        nearest = nearest < start ? nearest : start;
        const double gap = std::sqrt(nearest) - (r + static_cast<double>(run.radius[k]));
        gaps[k] = gap;
        below += gap < 0.0 ? 1 : 0;
    }
    return below;
}

FATHOM_CLONES
int64_t coneKernel(SphereSpan run, dvec3 centre, dvec3 axis, double cosine2, double keepBelow, double limit,
                   double* __restrict gaps) noexcept {
    int64_t below = 0;
    for (size_t k = 0; k < run.count; ++k) {
        const double dx = centre.x - static_cast<double>(run.x[k]);
        const double dy = centre.y - static_cast<double>(run.y[k]);
        const double dz = centre.z - static_cast<double>(run.z[k]);
        const double along = dx * axis.x + dy * axis.y + dz * axis.z;
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
void roomKernel(SphereSpan run, Sphere leaf, dvec3 axis, double cosine, double limit,
                const double* __restrict gaps, double* __restrict room) noexcept {
    for (size_t k = 0; k < run.count; ++k) {
        const double dx = leaf.centre.x - static_cast<double>(run.x[k]);
        const double dy = leaf.centre.y - static_cast<double>(run.y[k]);
        const double dz = leaf.centre.z - static_cast<double>(run.z[k]);
        const double length = gaps[k] + (leaf.radius + static_cast<double>(run.radius[k]));
        const double beyond = gaps[k] <= limit ? 0.0 : kInfinity;
        room[k] = dx * axis.x + dy * axis.y + dz * axis.z - cosine * length + beyond;
    }
}

// Bits of the largest radius, at least 0: bits of numbers >= 0 sort like integers.
FATHOM_CLONES
int32_t widestKernel(const float* __restrict radius, size_t count) noexcept {
    int32_t widest = 0;
    for (size_t k = 0; k < count; ++k) {
        const int32_t bits = std::bit_cast<int32_t>(radius[k]);
        widest = bits > widest ? bits : widest;
    }
    return widest;
}

FATHOM_CLONES
void upToKernel(const double* __restrict gaps, size_t count, double limit,
                uint8_t* __restrict marks) noexcept {
    for (size_t k = 0; k < count; ++k) {
        marks[k] = gaps[k] <= limit ? 1 : 0;
    }
}

FATHOM_CLONES
int64_t equalKernel(const double* __restrict gaps, double gap) noexcept {
    int64_t equal = 0;
    for (size_t k = 0; k < kGapBlock; ++k) {
        equal += gaps[k] == gap ? 1 : 0;
    }
    return equal;
}

FATHOM_CLONES
double smallestKernel(const double* __restrict gaps, size_t count) noexcept {
    GapLanes least[2], some[2]; // two, so that a comparison need not wait for the previous one
    least[0] = least[1] = GapLanes{} + kInfinity;
    size_t k = 0;
    for (; k + 2 * kGapLanes <= count; k += 2 * kGapLanes) {
        std::memcpy(&some, gaps + k, sizeof some);
        least[0] = some[0] < least[0] ? some[0] : least[0];
        least[1] = some[1] < least[1] ? some[1] : least[1];
    }
    least[0] = least[1] < least[0] ? least[1] : least[0];
    double smallest = kInfinity;
    for (size_t l = 0; l < kGapLanes; ++l) {
        smallest = least[0][l] < smallest ? least[0][l] : smallest;
    }
    for (; k < count; ++k) {
        smallest = gaps[k] < smallest ? gaps[k] : smallest;
    }
    return smallest;
}

} // namespace

double smallestGapOf(const double* gaps, size_t count) noexcept {
    return smallestKernel(gaps, count);
}

size_t indexOfGap(const double* gaps, size_t count, double gap) noexcept {
    size_t at = 0;
    while (at + kGapBlock <= count && equalKernel(gaps + at, gap) == 0) {
        at += kGapBlock;
    }
    while (at < count && gaps[at] != gap) {
        ++at;
    }
    return at;
}

size_t pairsWithin(const double* gaps, size_t count, double limit, uint32_t* chosen) noexcept {
    alignas(64) std::array<uint8_t, kGapBlock> marks;
    size_t found = 0;
    for (size_t begin = 0; begin < count; begin += kGapBlock) {
        const size_t length = std::min(kGapBlock, count - begin);
        std::fill(marks.begin() + static_cast<std::ptrdiff_t>(length), marks.end(), uint8_t{0});
        upToKernel(gaps + begin, length, limit, marks.data());
        for (size_t at = 0; at < length; at += 8) {
            uint64_t eight = 0;
            std::memcpy(&eight, marks.data() + at, 8);
            for (; eight != 0; eight &= eight - 1) {
                chosen[found++] =
                    static_cast<uint32_t>(begin + at + static_cast<size_t>(std::countr_zero(eight)) / 8);
            }
        }
    }
    return found;
}

ConeRoom roomInCone(const SphereSpan& run, const Sphere& leaf, const dvec3& axis, double cosine, double limit,
                    const double* gaps, double* scratch) noexcept {
    roomKernel(run, leaf, axis, cosine, limit, gaps, scratch);
    const float widest = std::bit_cast<float>(widestKernel(run.radius, run.count));
    return {smallestKernel(scratch, run.count), static_cast<double>(widest)};
}

size_t dropCone(const SphereSpan& run, const dvec3& centre, const dvec3& axis, double cosine,
                double keepBelow, double limit, double* gaps) noexcept {
    return static_cast<size_t>(coneKernel(run, centre, axis, cosine * cosine, keepBelow, limit, gaps));
}

size_t pairGaps(const SphereSpan& run, const Sphere& leaf, double limit, double* gaps) noexcept {
    return static_cast<size_t>(gapsKernel(run, leaf, limit, gaps));
}

size_t sweptGaps(const SphereSpan& run, const dvec3& from, const dvec3& to, double leafRadius,
                 double* gaps) noexcept {
    const dvec3 way = to - from;
    const double length2 = glm::dot(way, way);
    const double inverse = length2 > 1e-300 ? 1.0 / length2 : 0.0;
    return static_cast<size_t>(sweptKernel(run, from, to, inverse, leafRadius, gaps));
}

void memberGaps(const SphereSpan& run, const Sphere& leaf, double members, double* gaps) noexcept {
    memberKernel(run, leaf, members, gaps);
}

double gapOf(const SphereSpan& run, size_t k, const Sphere& leaf) noexcept {
    return exactGap(leaf, run.x[k], run.y[k], run.z[k], run.radius[k]);
}

} // namespace fathom
