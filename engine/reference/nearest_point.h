// SPDX-License-Identifier: Apache-2.0
// Nearest point under linear constraints by an independent method: least-distance programming through
// non-negative least squares (Lawson and Hanson, "Solving Least Squares Problems", 1974, chapter 23), in long
// double.
#pragma once

#include "engine/reference/kkt.h"

#include <vector>

namespace fathom {

struct NearestPoint {
    bool feasible = false;
    std::vector<double> x;           // the optimum; empty when infeasible
    std::vector<double> multipliers; // M (x - t) = sum lambda_i n_i
    double residual = 0.0; // |r| of the least-squares problem: 0 when infeasible, 1 when no row is needed
};

// Allocates; for tests and checks. Throws Error when M is not positive definite or after 10 x (rows +
// unknowns) steps without a result. A residual below 1e-12 counts as infeasible, since the rows would move x
// by 1e12 times the largest offset.
NearestPoint nearestPoint(const NearestPointProblem& problem);

} // namespace fathom
