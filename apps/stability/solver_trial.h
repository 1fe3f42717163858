// SPDX-License-Identifier: Apache-2.0
// Solves one row set and checks the answer in two ways: KKT conditions and an independent method, both in
// long double.
#pragma once

#include "engine/haptics/constraint_solver.h"
#include "engine/reference/nearest_point.h"
#include "engine/reference/row_sets.h"

#include <array>
#include <cstdint>
#include <optional>

namespace fathom::stability {

struct SolverTally {
    uint64_t sets = 0, optimal = 0, infeasible = 0;
    uint64_t disagreements = 0; // about feasibility
    uint64_t silent = 0;        // no reference: it gave up, or rounding the rows changes its answer
    uint64_t cycled = 0;        // stopped by the iteration limit
    double kkt = 0.0;           // largest of stationarity, dual and complementarity residuals, relative
    double violation = 0.0;     // largest violation over the length of the requested step, both in the metric
    double distance = 0.0;      // to the exact optimum, over |target| + |optimum|, in the metric
    double ofRounding = 0.0;    // a distance above 1e-9, over the optimum's shift from rounding the rows
    double changes = 0.0;       // largest count of added and dropped rows, over the iteration limit
    std::array<double, 10> byRows{}; // largest kkt, violation, distance; [k]: 2^k .. 2^(k+1) - 1 rows

    double worst() const;
    void add(const SolverTally& other);
};

// Keeps one solver warm from set to set, as the haptic tick does. For one thread.
class SolverTrial {
public:
    explicit SolverTrial(int unknowns = 6)
        : solver_(unknowns, kMaxRows) {}
    static constexpr size_t kMaxRows = 512;

    // Solves the set, adds the checks to `tally`, and returns the solver's status.
    SolveStatus judge(const RowSet& set, SolverTally& tally);

private:
    static std::optional<NearestPoint> reference(const RowSet& set); // empty when the second method gives up
    bool undecidable(const RowSet& set, SolveStatus status, const NearestPoint& truth) const;
    static double roundingShift(const RowSet& set, const NearestPoint& truth);
    SolverTally measure(const RowSet& set, const std::optional<NearestPoint>& truth) const;

    ConstraintSolver solver_;
    std::vector<double> x_;
};

// |v| in the set's row-major metric.
double metricLength(const RowSet& set, std::span<const double> v);

} // namespace fathom::stability
