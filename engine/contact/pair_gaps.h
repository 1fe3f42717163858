// SPDX-License-Identifier: Apache-2.0
// The kernels of the narrow phase: gaps between one tool leaf and a run of region spheres, float64.
#pragma once

#include "engine/contact/contact_set.h"
#include "engine/contact/sphere_span.h"
#include "engine/types/pose.h"
#include "engine/types/sphere_tree.h"

#include <cstddef>
#include <cstdint>

namespace fathom {

inline constexpr size_t kPairChunk = 2048;    // pairs per kernel call: the gaps stay in the L1 cache
inline constexpr double kPairRounding = 1e-9; // [m] margin of searches that start from an earlier gap

// Listed pairs [begin, end) of a set.
inline SphereSpan pairsOf(const ContactSet& set, uint32_t begin, uint32_t end) {
    return {set.pairX.data() + begin, set.pairY.data() + begin, set.pairZ.data() + begin,
            set.pairRadius.data() + begin, end - begin};
}

// exactGap() of the leaf and each sphere [m], written to gaps[0 .. count). Returns how many are <= limit.
// Identical bits on every instruction set, and identical to gapOf().
size_t pairGaps(const SphereSpan& run, const Sphere& leaf, double limit, double* gaps) noexcept;

// The same for every element whose gap in `gaps` is <= members; infinity for the others.
void memberGaps(const SphereSpan& run, const Sphere& leaf, double members, double* gaps) noexcept;

// Centre of the leaf relative to element k of the run [m].
inline dvec3 awayFrom(const SphereSpan& run, size_t k, const dvec3& centre) {
    return centre - dvec3(run.x[k], run.y[k], run.z[k]);
}

// Smallest gap; infinity when there is none. NaN is never the smallest.
double smallestGapOf(const double* gaps, size_t count) noexcept;

// First element with this gap; count when there is none.
size_t indexOfGap(const double* gaps, size_t count, double gap) noexcept;

// Writes the elements with gap <= limit to `chosen`, in ascending order; returns their number.
size_t pairsWithin(const double* gaps, size_t count, double limit, uint32_t* chosen) noexcept;

// Sets the gap to infinity for every pair with a normal within the cone about `axis` (unit; cosine of its
// half angle) and a gap not below `keepBelow`. Returns how many are still <= limit.
size_t dropCone(const SphereSpan& run, const dvec3& centre, const dvec3& axis, double cosine,
                double keepBelow, double limit, double* gaps) noexcept;

// How far the pairs with a gap <= limit are inside of the cone about `axis`, as along - cosine |d| of the
// direction d from sphere to leaf.
struct ConeRoom {
    double least;  // [m] infinity without such a pair
    double widest; // [m] largest radius of the run's spheres, at least 0
};
// gaps: of this leaf, by pairGaps(). scratch: run.count numbers.
ConeRoom roomInCone(const SphereSpan& run, const Sphere& leaf, const dvec3& axis, double cosine, double limit,
                    const double* gaps, double* scratch) noexcept;

// Smallest gap of each pair along the straight path of the leaf centre from `from` to `to`, including the
// exact gaps at both ends. Returns how many are < 0. So a step cannot jump over a sphere, however small.
size_t sweptGaps(const SphereSpan& run, const dvec3& from, const dvec3& to, double leafRadius,
                 double* gaps) noexcept;

// One pair: element k of the run.
double gapOf(const SphereSpan& run, size_t k, const Sphere& leaf) noexcept;

} // namespace fathom
