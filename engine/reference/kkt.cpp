// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/kkt.h"

#include "engine/reference/long_vector.h"
#include "engine/types/error.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double ratio(long double value, long double scale) {
    if (value <= 0.0L) {
        return 0.0;
    }
    return static_cast<double>(scale > 0.0L ? value / scale : value);
}

} // namespace

double KktResidual::worst() const {
    return std::max({stationarity, primal, dual, complementarity});
}

KktResidual checkKkt(const NearestPointProblem& problem, std::span<const double> x,
                     std::span<const double> multipliers) {
    const auto n = static_cast<Eigen::Index>(problem.unknowns);
    const Matrix metric =
        Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(problem.metric.data(), n, n)
            .cast<long double>();
    const Eigen::LLT<Matrix> cholesky(metric);
    if (cholesky.info() != Eigen::Success) {
        throw Error("KKT check: metric is not positive definite");
    }
    const LongVector t = longVector(problem.target), answer = longVector(x);
    const auto lower = cholesky.matrixL();
    const LongVector gradient =
        lower.adjoint() * (answer - t); // L^T (x - t): both sides are compared after L^-1
    const long double scale =
        LongVector(lower.adjoint() * t).norm() + LongVector(lower.adjoint() * answer).norm();

    KktResidual out;
    LongVector sum = LongVector::Zero(n);
    long double sumOfLengths = 0.0L, largest = 0.0L, negative = 0.0L, slack = 0.0L;
    for (size_t i = 0; i < problem.offsets.size(); ++i) {
        const LongVector normal = longVector(problem.normals.subspan(i * problem.unknowns, problem.unknowns));
        const LongVector unscaled = lower.solve(normal);
        const long double length = unscaled.norm();
        const long double violation = problem.offsets[i] - normal.dot(answer);
        // A row with a zero normal is either always satisfied or infeasible.
        out.primal =
            std::max(out.primal, length > 0.0L ? ratio(violation / length, scale) : ratio(violation, 0.0L));
        const long double lambda = static_cast<long double>(multipliers[i]);
        sum += lambda * unscaled;
        sumOfLengths += std::abs(lambda) * length;
        largest = std::max(largest, std::abs(lambda) * length);
        negative = std::max(negative, -lambda * length);
        slack = std::max(slack, length > 0.0L ? std::abs(lambda * violation) : 0.0L);
    }
    out.stationarity = ratio((gradient - sum).norm(), gradient.norm() + sumOfLengths);
    out.dual = ratio(negative, largest);
    out.complementarity = ratio(slack, largest * scale);
    return out;
}

} // namespace fathom
