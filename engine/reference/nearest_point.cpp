// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/nearest_point.h"

#include "engine/reference/long_vector.h"
#include "engine/types/error.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr long double kNoResidual = 1e-12L;
constexpr long double kGradient = 1e-16L;     // relative to the residual
constexpr long double kLongRounding = 1e-18L; // relative to f, whose length is 1

LongVector leastSquares(const Matrix& e, const LongVector& f, const std::vector<Eigen::Index>& passive) {
    Matrix columns(e.rows(), static_cast<Eigen::Index>(passive.size()));
    for (size_t i = 0; i < passive.size(); ++i) {
        columns.col(static_cast<Eigen::Index>(i)) = e.col(passive[i]);
    }
    return Eigen::HouseholderQR<Matrix>(columns).solve(f);
}

// Moves u towards the least-squares solution on the passive columns and removes columns that reach 0.
void settle(const Matrix& e, const LongVector& f, std::vector<Eigen::Index>& passive, LongVector& u) {
    while (!passive.empty()) {
        const LongVector wanted = leastSquares(e, f, passive);
        if (wanted.minCoeff() > 0.0L) {
            for (size_t i = 0; i < passive.size(); ++i) {
                u[passive[i]] = wanted[static_cast<Eigen::Index>(i)];
            }
            return;
        }
        long double step = 1.0L;
        size_t leaving = 0;
        for (size_t i = 0; i < passive.size(); ++i) {
            const long double w = wanted[static_cast<Eigen::Index>(i)], have = u[passive[i]];
            if (w <= 0.0L && have / (have - w) <= step) {
                step = have / (have - w);
                leaving = i;
            }
        }
        for (size_t i = 0; i < passive.size(); ++i) {
            u[passive[i]] += step * (wanted[static_cast<Eigen::Index>(i)] - u[passive[i]]);
        }
        u[passive[leaving]] = 0.0L;
        passive.erase(passive.begin() + static_cast<std::ptrdiff_t>(leaving));
    }
}

// min |E u - f| subject to u >= 0.
LongVector nonNegativeLeastSquares(const Matrix& e, const LongVector& f) {
    LongVector u = LongVector::Zero(e.cols());
    std::vector<Eigen::Index> passive;
    std::vector<char> refused(static_cast<size_t>(e.cols()), 0);
    for (Eigen::Index step = 0; step < 10 * (e.cols() + e.rows()); ++step) {
        const LongVector rest = f - e * u;
        if (rest.norm() < kNoResidual) {
            return u; // only rounding is left: no column has a gradient
        }
        const LongVector gradient = e.transpose() * rest;
        Eigen::Index best = -1;
        for (Eigen::Index i = 0; i < e.cols(); ++i) {
            const bool in = std::find(passive.begin(), passive.end(), i) != passive.end();
            const long double floor = e.col(i).norm() * (kGradient * rest.norm() + kLongRounding);
            if (!in && refused[static_cast<size_t>(i)] == 0 && gradient[i] > floor &&
                (best < 0 || gradient[i] > gradient[best])) {
                best = i;
            }
        }
        if (best < 0 || static_cast<Eigen::Index>(passive.size()) == e.rows()) {
            return u;
        }
        passive.push_back(best);
        // The new column must get a positive weight. If not, because of rounding, it gives no descent.
        if (leastSquares(e, f, passive)[static_cast<Eigen::Index>(passive.size()) - 1] <= 0.0L) {
            passive.pop_back();
            refused[static_cast<size_t>(best)] = 1;
            continue;
        }
        settle(e, f, passive, u);
        std::fill(refused.begin(), refused.end(), 0);
    }
    throw Error("nearest point: non-negative least squares does not end");
}

// z = L^T (x - t): columns (g; h) with g = L^-1 n / |.|, h = (d - n^T t) / |L^-1 n|.
struct LeastDistance {
    Eigen::LLT<Matrix> cholesky;
    LongVector target;
    Matrix columns;
    LongVector lengths;    // |L^-1 n|
    bool hopeless = false; // a row with a zero normal cannot be satisfied
};

LeastDistance leastDistance(const NearestPointProblem& problem) {
    const auto n = static_cast<Eigen::Index>(problem.unknowns);
    const auto m = static_cast<Eigen::Index>(problem.offsets.size());
    using RowMajor = Eigen::Matrix<double, -1, -1, Eigen::RowMajor>;
    const Matrix metric = Eigen::Map<const RowMajor>(problem.metric.data(), n, n).cast<long double>();
    LeastDistance out{Eigen::LLT<Matrix>(metric), longVector(problem.target), Matrix::Zero(n + 1, m),
                      LongVector::Zero(m)};
    if (out.cholesky.info() != Eigen::Success) {
        throw Error("nearest point: metric is not positive definite");
    }
    for (Eigen::Index i = 0; i < m; ++i) {
        const LongVector normal =
            longVector(problem.normals.subspan(static_cast<size_t>(i * n), problem.unknowns));
        const LongVector g = out.cholesky.matrixL().solve(normal);
        const long double h =
            static_cast<long double>(problem.offsets[static_cast<size_t>(i)]) - normal.dot(out.target);
        out.lengths[i] = g.norm();
        if (out.lengths[i] > 0.0L) {
            out.columns.col(i).head(n) = g / out.lengths[i];
            out.columns(n, i) = h / out.lengths[i];
        } else {
            out.hopeless = out.hopeless || h > 0.0L;
        }
    }
    return out;
}

} // namespace

NearestPoint nearestPoint(const NearestPointProblem& problem) {
    const auto n = static_cast<Eigen::Index>(problem.unknowns);
    LeastDistance ldp = leastDistance(problem);
    NearestPoint out;
    if (ldp.hopeless) {
        return out;
    }
    const long double largest = ldp.columns.cols() > 0 ? ldp.columns.row(n).maxCoeff() : 0.0L;
    out.multipliers.assign(problem.offsets.size(), 0.0);
    if (largest <= 0.0L) { // t itself satisfies every row
        out.feasible = true;
        out.residual = 1.0;
        out.x.assign(problem.target.begin(), problem.target.end());
        return out;
    }
    ldp.columns.row(n) /= largest; // brings |z| to order 1
    LongVector f = LongVector::Zero(n + 1);
    f[n] = 1.0L;
    const LongVector u = nonNegativeLeastSquares(ldp.columns, f);
    const LongVector rest = ldp.columns * u - f;
    out.residual = static_cast<double>(rest.norm());
    if (rest.norm() < kNoResidual || !(rest[n] < 0.0L)) {
        return out;
    }
    out.feasible = true;
    const LongVector z = -rest.head(n) / rest[n] * largest;
    const LongVector x = ldp.target + ldp.cholesky.matrixL().adjoint().solve(z);
    out.x.resize(problem.unknowns);
    for (size_t i = 0; i < out.x.size(); ++i) {
        out.x[i] = static_cast<double>(x[static_cast<Eigen::Index>(i)]);
    }
    for (size_t i = 0; i < out.multipliers.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const long double lambda = ldp.lengths[k] > 0.0L ? u[k] / -rest[n] * largest / ldp.lengths[k] : 0.0L;
        out.multipliers[i] = static_cast<double>(lambda);
    }
    return out;
}

} // namespace fathom
