// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/constraint_active_set.h"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

void subtract(ScaledVector& from, double factor, const ScaledVector& v) noexcept {
    for (size_t i = 0; i < kMaxUnknowns; ++i) {
        from[i] -= factor * v[i];
    }
}

} // namespace

bool ConstraintActiveSet::contains(size_t index) const noexcept {
    return std::find(row.begin(), row.begin() + count, index) != row.begin() + count;
}

ConstraintActiveSet::Split ConstraintActiveSet::split(const ScaledVector& g) const noexcept {
    Split out;
    out.z = g;
    // Two passes are enough: the second removes the cancellation error of the first, so that even for a row
    // parallel to 1e-9 z is orthogonal to the last digit.
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < count; ++k) {
            const double along = dot(q_[k], out.z);
            out.c[k] += along;
            subtract(out.z, along, q_[k]);
        }
    }
    out.length = std::sqrt(dot(out.z, out.z));
    out.r = solveUpper(out.c);
    return out;
}

void ConstraintActiveSet::append(size_t index, const ScaledVector& g, const Split& split, double bound,
                                 double excess) noexcept {
    const double inverse = 1.0 / split.length;
    for (size_t i = 0; i < kMaxUnknowns; ++i) {
        q_[count][i] = split.z[i] * inverse;
    }
    upper_[count] = split.c;
    upper_[count][count] = split.length;
    inverseDiagonal_[count] = inverse;
    normal_[count] = g;
    bound_[count] = bound;
    excess_[count] = excess;
    row[count] = index;
    ++count;
}

void ConstraintActiveSet::drop(int position) noexcept {
    --count;
    for (int k = position; k < count; ++k) {
        upper_[k] = upper_[k + 1];
        normal_[k] = normal_[k + 1];
        bound_[k] = bound_[k + 1];
        excess_[k] = excess_[k + 1];
        row[k] = row[k + 1];
        lambda[k] = lambda[k + 1];
    }
    // R has one number below its diagonal in each column from `position` on. Givens rotations remove it.
    for (int k = position; k < count; ++k) {
        const double a = upper_[k][k], b = upper_[k][k + 1];
        const double length = std::sqrt(a * a + b * b);
        inverseDiagonal_[k] = 1.0 / length;
        const double c = a * inverseDiagonal_[k], s = b * inverseDiagonal_[k];
        for (int column = k; column < count; ++column) {
            const double up = upper_[column][k], down = upper_[column][k + 1];
            upper_[column][k] = c * up + s * down;
            upper_[column][k + 1] = c * down - s * up;
        }
        for (size_t i = 0; i < kMaxUnknowns; ++i) {
            const double left = q_[k][i], right = q_[k + 1][i];
            q_[k][i] = c * left + s * right;
            q_[k + 1][i] = c * right - s * left;
        }
    }
}

ScaledVector ConstraintActiveSet::solveTransposed(const ScaledVector& right) const noexcept {
    ScaledVector w{};
    for (int k = 0; k < count; ++k) {
        double sum = right[k];
        for (int i = 0; i < k; ++i) {
            sum -= upper_[k][i] * w[i];
        }
        w[k] = sum * inverseDiagonal_[k];
    }
    return w;
}

ScaledVector ConstraintActiveSet::solveUpper(const ScaledVector& right) const noexcept {
    ScaledVector r{};
    for (int k = count - 1; k >= 0; --k) {
        double sum = right[k];
        for (int i = k + 1; i < count; ++i) {
            sum -= upper_[i][k] * r[i];
        }
        r[k] = sum * inverseDiagonal_[k];
    }
    return r;
}

void ConstraintActiveSet::addAlong(const ScaledVector& w, ScaledVector& y) const noexcept {
    for (int k = 0; k < count; ++k) {
        subtract(y, -w[k], q_[k]);
    }
}

void ConstraintActiveSet::solve(const ScaledVector& s, ScaledVector& y) noexcept {
    const ScaledVector w = solveTransposed(excess_);
    y = s;
    addAlong(w, y);
    const ScaledVector r = solveUpper(w);
    for (int k = 0; k < count; ++k) {
        lambda[k] = std::max(0.0, r[k]); // rounding may give an inactive row -1e-17
    }
}

void ConstraintActiveSet::refine(ScaledVector& y) const noexcept {
    ScaledVector lacking{};
    for (int k = 0; k < count; ++k) {
        lacking[k] = bound_[k] - dot(normal_[k], y);
    }
    addAlong(solveTransposed(lacking), y);
}

} // namespace fathom
