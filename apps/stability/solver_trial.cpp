// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/solver_trial.h"

#include "engine/reference/nearest_point.h"

#include "engine/types/error.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kReferenceHolds = 1e-6;
constexpr double kCheckAbove = 1e-9; // smaller distances and residuals need no closer check
constexpr double kEpsilon = 2.2204460492503131e-16;

// The same set with every coefficient of its rows changed by one rounding error, up or down.
RowSet rounded(const RowSet& set, uint64_t seed) {
    Rng rng(seed);
    RowSet out = set;
    for (double& value : out.normals) {
        value *= rng.chance(0.5) ? 1.0 + kEpsilon : 1.0 - kEpsilon;
    }
    return out;
}

double distanceBetween(const RowSet& set, std::span<const double> a, std::span<const double> b) {
    std::vector<double> difference(set.unknowns);
    for (size_t i = 0; i < set.unknowns; ++i) {
        difference[i] = a[i] - b[i];
    }
    return metricLength(set, difference);
}

} // namespace

double metricLength(const RowSet& set, std::span<const double> v) {
    double sum = 0.0;
    for (size_t i = 0; i < v.size(); ++i) {
        for (size_t j = 0; j < v.size(); ++j) {
            sum += v[i] * set.metric[i * v.size() + j] * v[j];
        }
    }
    return std::sqrt(std::max(0.0, sum));
}

double SolverTally::worst() const {
    return std::max({kkt, violation, distance});
}

void SolverTally::add(const SolverTally& other) {
    sets += other.sets;
    optimal += other.optimal;
    infeasible += other.infeasible;
    disagreements += other.disagreements;
    silent += other.silent;
    cycled += other.cycled;
    kkt = std::max(kkt, other.kkt);
    violation = std::max(violation, other.violation);
    distance = std::max(distance, other.distance);
    ofRounding = std::max(ofRounding, other.ofRounding);
    changes = std::max(changes, other.changes);
    for (size_t i = 0; i < byRows.size(); ++i) {
        byRows[i] = std::max(byRows[i], other.byRows[i]);
    }
}

std::optional<NearestPoint> SolverTrial::reference(const RowSet& set) {
    try {
        NearestPoint truth = nearestPoint(set.problem());
        // If the rows contradict each other by less than the method's residual, it returns a distant point
        // that violates them. Such an answer means infeasible.
        truth.feasible =
            truth.feasible && checkKkt(set.problem(), truth.x, truth.multipliers).worst() < kReferenceHolds;
        return truth;
    } catch (const Error&) { // no convergence
        return std::nullopt;
    }
}

SolveStatus SolverTrial::judge(const RowSet& set, SolverTally& tally) {
    solver_.setMetric(set.metric);
    solver_.clearRows();
    for (size_t i = 0; i < set.rows(); ++i) {
        solver_.addRow(set.normal(i), set.offsets[i]);
    }
    x_.assign(set.unknowns, 0.0);
    const SolveStatus status = solver_.solve(set.target, x_);
    ++tally.sets;
    tally.cycled += status == SolveStatus::IterationLimit ? 1 : 0;
    tally.changes = std::max(tally.changes, static_cast<double>(solver_.changes()) / solver_.mostChanges());
    const std::optional<NearestPoint> truth = reference(set);
    tally.silent += truth ? 0 : 1;
    if (truth && (status == SolveStatus::Optimal) != truth->feasible) {
        ++(undecidable(set, status, *truth) ? tally.silent : tally.disagreements);
        return status;
    }
    if (status != SolveStatus::Optimal) {
        ++tally.infeasible;
        return status;
    }
    ++tally.optimal;
    tally.add(measure(set, truth));
    return status;
}

// Two reasons to distrust the reference: the solver's point satisfies every row, which the reference's
// residual of 1e-12 cannot distinguish from infeasible; or rounding the rows changes the reference's answer.
bool SolverTrial::undecidable(const RowSet& set, SolveStatus status, const NearestPoint& truth) const {
    if (status == SolveStatus::Optimal) {
        return checkKkt(set.problem(), x_, solver_.multipliers()).worst() < kCheckAbove;
    }
    bool ticks = false;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const std::optional<NearestPoint> other = reference(rounded(set, seed));
        ticks = ticks || !other || other->feasible != truth.feasible;
    }
    return ticks;
}

// How far rounding the rows moves the exact optimum. No float64 method can be expected to get closer.
double SolverTrial::roundingShift(const RowSet& set, const NearestPoint& truth) {
    double shift = 0.0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const std::optional<NearestPoint> other = reference(rounded(set, seed));
        if (other && other->feasible) {
            shift = std::max(shift, distanceBetween(set, other->x, truth.x));
        }
    }
    return shift;
}

SolverTally SolverTrial::measure(const RowSet& set, const std::optional<NearestPoint>& truth) const {
    const KktResidual kkt = checkKkt(set.problem(), x_, solver_.multipliers());
    const double target = metricLength(set, set.target), found = metricLength(set, x_);
    SolverTally one;
    one.kkt = std::max({kkt.stationarity, kkt.dual, kkt.complementarity});
    one.violation = kkt.primal * (target + found) / target;
    if (truth) {
        const double scale = target + metricLength(set, truth->x);
        one.distance = distanceBetween(set, x_, truth->x) / scale;
        if (one.distance > kCheckAbove) {
            one.ofRounding = one.distance / std::max(kEpsilon, roundingShift(set, *truth) / scale);
        }
    }
    one.byRows[std::bit_width(std::max<size_t>(1, set.rows())) - 1] = one.worst();
    return one;
}

} // namespace fathom::stability
