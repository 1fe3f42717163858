// SPDX-License-Identifier: Apache-2.0
// Goldfarb and Idnani, "A numerically stable dual method for solving strictly convex quadratic programs"
// (1983), with the Hessian turned into the identity: y = L^T x. Every iterate is the optimum over its active
// rows. Each full step adds a violated row and raises the cost, so the method terminates. Symbols follow the
// paper.
#include "engine/haptics/constraint_solver.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A row is violated beyond this share of |s| + |y|: above rounding (about 1e-15), below the accuracy of the
// result.
constexpr double kTolerance = 1e-13;
// A unit row depends on the active rows when its component outside their span is shorter than this. Rows
// parallel to 1e-9 still count as independent.
constexpr double kDependent = 1e-12;
// Share of the largest |r| below which r is rounding and no row is dropped for it.
constexpr double kBlocking = 1e-13;

double norm(const ScaledVector& v) noexcept {
    return std::sqrt(dot(v, v));
}

// Largest t for which no multiplier becomes negative, and the limiting row; the smallest row on ties.
struct DualStep {
    double t = kInfinity;
    int position = -1;
};

DualStep longestDualStep(const ConstraintActiveSet& active, const ScaledVector& r) noexcept {
    double largest = 1.0;
    for (int k = 0; k < active.count; ++k) {
        largest = std::max(largest, std::abs(r[k]));
    }
    DualStep step;
    for (int k = 0; k < active.count; ++k) {
        if (r[k] <= kBlocking * largest) {
            continue;
        }
        const double t = active.lambda[k] / r[k];
        const bool tie = step.position >= 0 && t == step.t && active.row[k] < active.row[step.position];
        if (t < step.t || tie) {
            step = {t, k};
        }
    }
    return step;
}

} // namespace

ConstraintSolver::ConstraintSolver(int unknowns, size_t maxRows)
    : n_(unknowns)
    , rows_(unknowns, maxRows)
    , keys_(maxRows)
    , multipliers_(maxRows) {
    if (unknowns < 1 || unknowns > kMaxUnknowns) {
        throw Error("constraint solver: " + std::to_string(unknowns) + " unknowns (allowed: 1.." +
                    std::to_string(kMaxUnknowns) + ")");
    }
    factor_.inverseDiagonal.fill(1.0);
    for (int i = 0; i < kMaxUnknowns; ++i) {
        factor_.lower[i * kMaxUnknowns + i] = 1.0;
    }
}

void ConstraintSolver::setMetric(std::span<const double> metric) {
    const size_t n = static_cast<size_t>(n_);
    if (metric.size() != n * n) {
        throw Error("constraint solver: metric of " + std::to_string(metric.size()) + " numbers for " +
                    std::to_string(n_) + " unknowns");
    }
    MetricFactor factor;
    for (size_t i = 0; i < n; ++i) {
        for (size_t j = 0; j <= i; ++j) {
            const double value = metric[i * n + j];
            if (!(std::abs(value - metric[j * n + i]) <= 1e-12 * std::abs(value))) {
                throw Error("constraint solver: metric is not symmetric or not finite");
            }
            double sum = value;
            for (size_t k = 0; k < j; ++k) {
                sum -= factor.lower[i * kMaxUnknowns + k] * factor.lower[j * kMaxUnknowns + k];
            }
            if (i != j) {
                factor.lower[i * kMaxUnknowns + j] = sum * factor.inverseDiagonal[j];
                factor.diagonal = factor.diagonal && sum == 0.0;
                continue;
            }
            // Rounding makes a singular matrix look definite by about n eps, so require a little more.
            if (!(sum > 1e-15 * value) || !std::isfinite(value)) {
                throw Error("constraint solver: metric is not positive definite");
            }
            factor.lower[i * kMaxUnknowns + i] = std::sqrt(sum);
            factor.inverseDiagonal[i] = 1.0 / factor.lower[i * kMaxUnknowns + i];
        }
    }
    factor_ = factor;
    rows_.forgetScaling();
}

void ConstraintSolver::clearRows() noexcept {
    rows_.clear();
    active_.count = 0;
}

bool ConstraintSolver::addRow(std::span<const double> normal, double offset) noexcept {
    const size_t row = rows_.size();
    if (!rows_.add(normal, offset)) {
        return false;
    }
    keys_[row] = row;
    multipliers_[row] = 0.0;
    return true;
}

// Active rows of the last optimal solve, found by their key.
void ConstraintSolver::findWarmRows() noexcept {
    warmRows_ = 0;
    for (int k = 0; k < lastActive_; ++k) {
        const size_t hint = lastRow_[k];
        if (hint < rows_.size() && keys_[hint] == lastKey_[k]) {
            warmRow_[warmRows_++] = hint;
            continue;
        }
        const auto end = keys_.begin() + static_cast<std::ptrdiff_t>(rows_.size());
        const auto found = std::find(keys_.begin(), end, lastKey_[k]);
        if (found != end) {
            warmRow_[warmRows_++] = static_cast<size_t>(found - keys_.begin());
        }
    }
}

// The violated row to add next: a warm-start row if any is left, else the worst of all. rows() = none.
size_t ConstraintSolver::pickRow(const ScaledVector& y, double tolerance, double& amount) noexcept {
    ConstraintRows::Violation worst{tolerance, rows_.size()};
    for (int k = 0; k < warmRows_; ++k) {
        const double violation = violationOf(warmRow_[k], y);
        if (violation > worst.amount && !active_.contains(warmRow_[k])) {
            worst = {violation, warmRow_[k]};
        }
    }
    if (worst.row == rows_.size()) {
        worst = rows_.worst(y.data(), tolerance);
    }
    if (worst.row < rows_.size() && active_.contains(worst.row)) { // rounding beyond the tolerance: skip it
        worst = {tolerance, rows_.size()};
        for (size_t row = 0; row < rows_.size(); ++row) {
            const double violation = violationOf(row, y);
            if (violation > worst.amount && !active_.contains(row)) {
                worst = {violation, row};
            }
        }
    }
    amount = worst.amount;
    return worst.row;
}

double ConstraintSolver::violationOf(size_t row, const ScaledVector& y) const noexcept {
    ScaledVector g;
    rows_.unitRow(row, g.data());
    return rows_.bound(row) - dot(g, y);
}

// Adds one violated row and drops rows whose multiplier would become negative. False: no point satisfies it
// together with the active rows.
bool ConstraintSolver::enforce(size_t row, double violation, const ScaledVector& s,
                               ScaledVector& y) noexcept {
    ScaledVector g;
    rows_.unitRow(row, g.data());
    const double bound = rows_.bound(row);
    for (;;) {
        ++changes_;
        const auto split = active_.split(g);
        const DualStep dual = longestDualStep(active_, split.r);
        const bool independent = active_.count < n_ && split.length > kDependent;
        const double primal = independent ? violation / (split.length * split.length) : kInfinity;
        const double t = std::min(dual.t, primal);
        if (!(t < kInfinity)) {
            return false;
        }
        for (int k = 0; k < active_.count; ++k) {
            active_.lambda[k] = std::max(0.0, active_.lambda[k] - t * split.r[k]);
        }
        if (primal <= dual.t) {
            active_.append(row, g, split, bound, bound - dot(g, s));
            active_.solve(s, y);
            return true;
        }
        active_.drop(dual.position);
        if (independent) {
            for (int i = 0; i < kMaxUnknowns; ++i) {
                y[i] += t * split.z[i];
            }
            violation = bound - dot(g, y);
        }
    }
}

// L^T target.
ScaledVector ConstraintSolver::scaled(std::span<const double> target) const noexcept {
    ScaledVector s{};
    for (int i = 0; i < n_; ++i) {
        for (int j = i; j < n_; ++j) {
            s[i] += factor_.lower[j * kMaxUnknowns + i] * target[j];
        }
    }
    return s;
}

SolveStatus ConstraintSolver::solve(std::span<const double> target, std::span<double> x) noexcept {
    for (int k = 0; k < active_.count; ++k) {
        multipliers_[active_.row[k]] = 0.0;
    }
    active_.count = 0;
    rows_.prepare(factor_);
    const ScaledVector s = scaled(target);
    std::copy_n(target.begin(), n_, x.begin());
    const double sLength = norm(s);
    changes_ = 0;
    if (!std::isfinite(sLength)) {
        return SolveStatus::Infeasible;
    }
    findWarmRows();
    ScaledVector y = s;
    const int cap = mostChanges();
    SolveStatus status = SolveStatus::Optimal;
    for (;;) {
        const double tolerance = kTolerance * (sLength + norm(y));
        if (!(tolerance < kInfinity)) { // overflow: absurdly large target or row
            status = SolveStatus::Infeasible;
            break;
        }
        double violation = 0.0;
        const size_t row = pickRow(y, tolerance, violation);
        if (row == rows_.size()) {
            break;
        }
        if (changes_ >= cap) {
            status = SolveStatus::IterationLimit;
            break;
        }
        if (!(violation < kInfinity) || !enforce(row, violation, s, y)) {
            status = SolveStatus::Infeasible;
            break;
        }
    }
    finish(status, y, x);
    return status;
}

// L^-T y.
void ConstraintSolver::unscale(const ScaledVector& y, std::span<double> x) const noexcept {
    for (int i = n_ - 1; i >= 0; --i) {
        double sum = y[i];
        for (int j = i + 1; j < n_; ++j) {
            sum -= factor_.lower[j * kMaxUnknowns + i] * x[j];
        }
        x[i] = sum * factor_.inverseDiagonal[i];
    }
}

void ConstraintSolver::finish(SolveStatus status, ScaledVector& y, std::span<double> x) noexcept {
    if (status != SolveStatus::Optimal) {
        active_.count = 0;
    }
    if (active_.count > 0) { // otherwise x is exactly the target
        active_.refine(y);
        unscale(y, x);
    }
    lastActive_ = active_.count;
    for (int k = 0; k < active_.count; ++k) {
        const size_t row = active_.row[k];
        multipliers_[row] = active_.lambda[k] * rows_.inverseLength(row);
        lastKey_[k] = keys_[row];
        lastRow_[k] = row;
    }
}

} // namespace fathom
