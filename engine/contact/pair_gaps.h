// SPDX-License-Identifier: Apache-2.0
// The kernels of the narrow phase: gaps between one tool leaf and a run of region spheres, float64.
#pragma once

#include "engine/types/pose.h"

#include <cstddef>

namespace fathom {

// A run of region spheres, about one origin [m]. The arrays hold float32, the arithmetic is float64: exact values.
struct PairArrays {
    const float* x;
    const float* y;
    const float* z;
    const float* radius;
    size_t count;
};

// gap = |centre - sphere| - (leafRadius + R) [m], written to gaps[0 .. count). Returns how many are <= limit. The same bits
// on every instruction set, and the same as gapOf().
size_t pairGaps(const PairArrays& run, const dvec3& centre, double leafRadius, double limit, double* gaps) noexcept;

// Smallest gap along the straight way of the leaf centre from `from` to `to`, both ends' own gaps included bit by bit.
// Returns how many are < 0. A step of 2 mm cannot jump over a sphere, however small.
size_t sweptGaps(const PairArrays& run, const dvec3& from, const dvec3& to, double leafRadius, double* gaps) noexcept;

// One pair: element k of the run.
double gapOf(const PairArrays& run, size_t k, const dvec3& centre, double leafRadius) noexcept;

} // namespace fathom
