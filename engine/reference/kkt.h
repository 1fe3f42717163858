// SPDX-License-Identifier: Apache-2.0
// Karush-Kuhn-Tucker check of a nearest-point answer: minimise (x - t)^T M (x - t) subject to n_i^T x >= d_i.
// The problem is strictly convex, so these four conditions prove that x is the unique optimum.
#pragma once

#include <cstddef>
#include <span>

namespace fathom {

// All row-major. normals has rows * unknowns numbers.
struct NearestPointProblem {
    size_t unknowns = 0;
    std::span<const double> metric; // unknowns x unknowns
    std::span<const double> target;
    std::span<const double> normals;
    std::span<const double> offsets; // one per row
};

// Relative residuals, all >= 0, computed in long double; 0 is exact. Lengths use the metric: |v|_M = sqrt(v^T
// M v), |n| = sqrt(n^T M^-1 n). The scale is |t|_M + |x|_M.
struct KktResidual {
    double stationarity = 0.0;    // |M (x - t) - sum lambda_i n_i| over |M (x - t)| + sum lambda_i |n_i|
    double primal = 0.0;          // largest (d_i - n_i^T x) / |n_i| over the scale
    double dual = 0.0;            // largest -lambda_i |n_i| over the largest lambda_i |n_i|
    double complementarity = 0.0; // largest lambda_i |n_i^T x - d_i| over (largest lambda_i |n_i|) x scale

    double worst() const;
};

// Allocates; for tests and checks. Throws Error when M is not positive definite.
KktResidual checkKkt(const NearestPointProblem& problem, std::span<const double> x,
                     std::span<const double> multipliers);

} // namespace fathom
