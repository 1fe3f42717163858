// SPDX-License-Identifier: Apache-2.0
// One row set through the solver and through two judges: the KKT conditions and an unrelated method, both in
// long double.
#pragma once

#include "apps/stability/constraint_families.h"
#include "engine/haptics/constraint_solver.h"
#include "engine/reference/nearest_point.h"

#include <array>
#include <cstdint>
#include <optional>

namespace fathom::stability {

struct SolverTally {
    uint64_t sets = 0, optimal = 0, infeasible = 0;
    uint64_t disagreements = 0; // about whether any point obeys all rows
    uint64_t silent = 0;        // no second opinion: it gave up, or one rounding of the rows turns it
    uint64_t cycled = 0;        // ended by the guard
    double kkt = 0.0;           // worst of stationarity, dual, complementarity, relative
    double violation = 0.0;  // worst violated row over the length of the step asked for, both by the metric
    double distance = 0.0;   // to the exact optimum over |target| + |optimum|, by the metric
    double ofRounding = 0.0; // the same over what one rounding of the rows moves the optimum where above 1e-9
    double changes = 0.0;    // most rows taken in or dropped, over the guard's figure
    std::array<double, 10> byRows{}; // worst of kkt, violation, distance for sets of 2^k .. 2^(k+1) - 1 rows

    double worst() const;
    void add(const SolverTally& other);
};

// Keeps one solver, warm from set to set as the haptic tick does. One thread.
class SolverTrial {
public:
    explicit SolverTrial(int unknowns = 6)
        : solver_(unknowns, kMostRows) {}
    static constexpr size_t kMostRows = 512;

    // Solves and judges. Returns the status that the solver gave.
    SolveStatus judge(const RowSet& set, SolverTally& tally);

private:
    static std::optional<NearestPoint> reference(const RowSet& set); // empty when the second method gives up
    bool undecidable(const RowSet& set, SolveStatus status, const NearestPoint& truth) const;
    static double roundingShift(const RowSet& set, const NearestPoint& truth);
    SolverTally measure(const RowSet& set, const std::optional<NearestPoint>& truth) const;

    ConstraintSolver solver_;
    std::vector<double> x_;
};

// |v| by a row-major metric.
double metricLength(const RowSet& set, std::span<const double> v);

} // namespace fathom::stability
