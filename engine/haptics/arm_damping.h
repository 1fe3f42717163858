// SPDX-License-Identifier: Apache-2.0
// Damped least squares in joint space: the matrix J^T M J + lambda^2 I, its factor and the singular values of
// M^1/2 J.
#pragma once

#include "engine/model/arm_model.h"

#include <span>

namespace fathom {

// No allocation, noexcept. Columns are M^1/2 J: [v; k omega] [m] per unit of joint motion.
class ArmNormal {
public:
    explicit ArmNormal(size_t joints) noexcept
        : n_(joints) {}
    void addColumn(size_t joint, const dvec3& v, const dvec3& scaledOmega) noexcept {
        const std::array<double, 6> more{v.x, v.y, v.z, scaledOmega.x, scaledOmega.y, scaledOmega.z};
        for (size_t i = 0; i < more.size(); ++i) {
            columns_[joint][i] += more[i];
        }
    }
    // A joint that cannot move: its column is excluded from smallestSingular().
    void exclude(size_t joint) noexcept { excluded_[joint] = true; }
    // Smallest singular value [m] of the included columns, or of the rows when there are more joints than
    // rows: 6, or 3 where directions do not count (k = 0). Computed by Jacobi rotations of the smaller Gram
    // matrix.
    double smallestSingular(size_t rows = 6) const noexcept;
    void damp(double lambda) noexcept; // fills metric()
    std::span<const double> metric() const noexcept { return {metric_.data(), n_ * n_}; }
    std::array<std::array<double, kMaxJoints>, kMaxJoints> gram() const noexcept; // J^T M J
    // J^T M x for x = [a; alpha], alpha scaled by k.
    void gradient(const dvec3& a, const dvec3& scaledAlpha, JointVector& out) const noexcept;
    // (J^T M J + lambda^2 I)^-1 J^T M x for x = [a; alpha], alpha scaled by k. After damp().
    void solve(const dvec3& a, const dvec3& scaledAlpha, JointVector& out) const noexcept;

private:
    size_t n_;
    std::array<std::array<double, 6>, kMaxJoints> columns_{};
    std::array<bool, kMaxJoints> excluded_{};
    std::array<double, kMaxJoints * kMaxJoints> metric_{};
};

// lambda: `least` where the smallest singular value is above `below`, rising to `most` at 0: lambda^2 grows
// with (1 - s / below)^2 (Nakamura and Hanafusa 1986).
double dampingFor(double smallest, double below, double least, double most) noexcept;

} // namespace fathom
