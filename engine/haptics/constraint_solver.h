// SPDX-License-Identifier: Apache-2.0
// Nearest point under linear constraints: minimise (x - t)^T M (x - t) subject to n_i^T x >= d_i for all
// rows. Dual active-set method of Goldfarb and Idnani (1983) after scaling by the Cholesky factor of M; paper
// V.B.
#pragma once

#include "engine/haptics/constraint_active_set.h"
#include "engine/haptics/constraint_rows.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// How a solve ended.
enum class SolveStatus {
    Optimal,
    Infeasible,     // no x satisfies all rows; x is the last iterate, do not use it
    IterationLimit, // cycling guard: treat as infeasible
};

// One thread. Allocates in the constructor only. Unknowns of a free tool: [a; alpha], translation [m] and
// rotation vector [rad] about the tool's centre.
class ConstraintSolver {
public:
    // unknowns: 1..kMaxUnknowns. addRow() rejects rows beyond maxRows.
    ConstraintSolver(int unknowns, size_t maxRows);

    // n x n, row-major, symmetric positive definite: throws Error otherwise.
    void setMetric(std::span<const double> metric);

    void clearRows() noexcept;
    // False when full. Rows of zero length are kept: they are infeasible when offset > 0 and inactive
    // otherwise.
    bool addRow(std::span<const double> normal, double offset) noexcept;
    void setOffset(size_t row, double offset) noexcept { rows_.setOffset(row, offset); }
    double offset(size_t row) const noexcept { return rows_.offset(row); }
    size_t rows() const noexcept { return rows_.size(); }

    // Warm start: rows whose key was active in the last solve are tried first; the answer does not depend on
    // it beyond rounding. key is any number that names the contact (default: the row's index).
    void setKey(size_t row, uint64_t key) noexcept { keys_[row] = key; }

    SolveStatus solve(std::span<const double> target, std::span<double> x) noexcept;

    // Multipliers of the last optimal solve, one per row, >= 0, such that M (x - t) = sum lambda_i n_i.
    std::span<const double> multipliers() const noexcept { return {multipliers_.data(), rows_.size()}; }
    int activeRows() const noexcept { return active_.count; }
    // Rows added or dropped by the last solve, and the limit at which it gives up (cycling guard).
    int changes() const noexcept { return changes_; }
    int mostChanges() const noexcept { return 16 * n_ + 64 + static_cast<int>(rows_.size() / 4); }

private:
    ScaledVector scaled(std::span<const double> target) const noexcept;
    void findWarmRows() noexcept;
    size_t pickRow(const ScaledVector& y, double tolerance, double& amount) noexcept;
    double violationOf(size_t row, const ScaledVector& y) const noexcept;
    bool enforce(size_t row, double violation, const ScaledVector& s, ScaledVector& y) noexcept;
    void unscale(const ScaledVector& y, std::span<double> x) const noexcept;
    void finish(SolveStatus status, ScaledVector& y, std::span<double> x) noexcept;

    int n_ = 0;
    int changes_ = 0;
    MetricFactor factor_;
    ConstraintRows rows_;
    std::vector<uint64_t> keys_;
    std::vector<double> multipliers_;
    ConstraintActiveSet active_;
    // Active rows of the last optimal solve, and their present indices.
    int lastActive_ = 0, warmRows_ = 0;
    std::array<uint64_t, kMaxUnknowns> lastKey_{};
    std::array<size_t, kMaxUnknowns> lastRow_{}, warmRow_{};
};

} // namespace fathom
