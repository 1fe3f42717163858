// SPDX-License-Identifier: Apache-2.0
// The active rows of the dual method and their orthogonal factorisation N = Q R, kept up to date row by row.
#pragma once

#include "engine/haptics/constraint_rows.h"

#include <array>

namespace fathom {

using ScaledVector = std::array<double, kMaxUnknowns>; // numbers past the unknowns are zero

inline double dot(const ScaledVector& a, const ScaledVector& b) noexcept {
    // Pairwise to shorten the chain of additions, in a fixed order so that the result is reproducible.
    const double even = (a[0] * b[0] + a[2] * b[2]) + (a[4] * b[4] + a[6] * b[6]);
    const double odd = (a[1] * b[1] + a[3] * b[3]) + (a[5] * b[5] + a[7] * b[7]);
    const double rest = (a[8] * b[8] + a[10] * b[10]) + (a[9] * b[9] + a[11] * b[11]);
    return (even + odd) + rest;
}

// At most kMaxUnknowns unit rows, linearly independent. One thread, noexcept, no allocation.
class ConstraintActiveSet {
public:
    int count = 0;
    std::array<size_t, kMaxUnknowns> row{};    // index of each active row
    std::array<double, kMaxUnknowns> lambda{}; // its multiplier, scaled space

    bool contains(size_t index) const noexcept;

    // Splits g into its part along the active rows, N r, and the rest z, orthogonal to all of them.
    struct Split {
        ScaledVector c{}; // Q^T g
        ScaledVector r{}; // R r = c
        ScaledVector z{};
        double length = 0.0; // |z|
    };
    Split split(const ScaledVector& g) const noexcept;

    // Appends the row that was split, length > 0; excess = bound - row . s for the unconstrained point s.
    void append(size_t index, const ScaledVector& g, const Split& split, double bound,
                double excess) noexcept;
    void drop(int position) noexcept;

    // y = nearest point to s on all active rows, and lambda with y - s = N lambda.
    void solve(const ScaledVector& s, ScaledVector& y) noexcept;
    // One correction of y by the remaining violation of the active rows. Reduces |row . y - bound| to the
    // rounding of |y|, not of |s|.
    void refine(ScaledVector& y) const noexcept;

private:
    ScaledVector solveTransposed(const ScaledVector& right) const noexcept; // R^T w = right
    ScaledVector solveUpper(const ScaledVector& right) const noexcept;      // R r = right
    void addAlong(const ScaledVector& w, ScaledVector& y) const noexcept;   // y += Q w

    std::array<ScaledVector, kMaxUnknowns> q_{};      // columns of Q
    std::array<ScaledVector, kMaxUnknowns> upper_{};  // columns of R
    std::array<ScaledVector, kMaxUnknowns> normal_{}; // the rows themselves
    ScaledVector bound_{}, excess_{};
    ScaledVector inverseDiagonal_{}; // of R
};

} // namespace fathom
