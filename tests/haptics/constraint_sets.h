// SPDX-License-Identifier: Apache-2.0
// Random row sets in a solver.
#pragma once

#include "engine/haptics/constraint_solver.h"
#include "engine/reference/row_sets.h"

namespace fathom {

// n: 3 or 6 unknowns of a tool, or another number for the joints of an arm. radius: of gyration [m].
inline RowSet makeSet(RowFamily family, size_t n, size_t rows, double radius, Rng& rng) {
    if (n != 3 && n != 6) {
        return makeArmSet(n, rows, 1e-4, rng);
    }
    RowScale scale;
    scale.radius = radius;
    scale.unknowns = n;
    return makeRowSet(family, rows, scale, rng);
}

inline void load(ConstraintSolver& solver, const RowSet& set) {
    solver.setMetric(set.metric);
    solver.clearRows();
    for (size_t i = 0; i < set.rows(); ++i) {
        solver.addRow(set.normal(i), set.offsets[i]);
    }
}

} // namespace fathom
