// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_damping.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

// An off-diagonal element this small relative to the diagonal does not change the eigenvalues in float64.
// Relative criterion for a Gram matrix: Demmel and Veselic, "Jacobi's method is more accurate than QR", 1992.
constexpr double kRotated2 = 1e-34; // squared

// Smallest eigenvalue of a symmetric m x m matrix by cyclic Jacobi rotations, until a sweep needs none.
template <size_t kMost>
double smallestEigenvalue(std::array<std::array<double, kMost>, kMost>& a, size_t m) {
    bool rotated = true;
    for (int sweep = 0; sweep < 10 && rotated; ++sweep) {
        rotated = false;
        for (size_t p = 0; p < m; ++p) {
            for (size_t q = p + 1; q < m; ++q) {
                const double off = a[p][q];
                if (std::abs(off) < 1e-300 || off * off <= kRotated2 * std::abs(a[p][p] * a[q][q])) {
                    continue;
                }
                rotated = true;
                const double theta = (a[q][q] - a[p][p]) / (2.0 * off);
                const double t =
                    (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
                const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
                for (size_t i = 0; i < m; ++i) {
                    const double ip = a[i][p], iq = a[i][q];
                    a[i][p] = c * ip - s * iq;
                    a[i][q] = s * ip + c * iq;
                }
                for (size_t i = 0; i < m; ++i) {
                    const double pi = a[p][i], qi = a[q][i];
                    a[p][i] = c * pi - s * qi;
                    a[q][i] = s * pi + c * qi;
                }
            }
        }
    }
    double least = a[0][0];
    for (size_t i = 1; i < m; ++i) {
        least = std::min(least, a[i][i]);
    }
    return least;
}

} // namespace

double ArmNormal::smallestSingular(size_t rows) const noexcept {
    std::array<std::array<double, kMostJoints>, kMostJoints> gram{};
    std::array<std::array<double, 6>, kMostJoints> columns{};
    size_t count = 0;
    for (size_t k = 0; k < n_; ++k) {
        columns[count] = columns_[k];
        count += leftOut_[k] ? 0 : 1;
    }
    const bool wide = count > rows;
    const size_t m = wide ? rows : count;
    for (size_t i = 0; i < m; ++i) {
        for (size_t j = 0; j < m; ++j) {
            const size_t inner = wide ? count : 6;
            for (size_t k = 0; k < inner; ++k) {
                gram[i][j] += wide ? columns[k][i] * columns[k][j] : columns[i][k] * columns[j][k];
            }
        }
    }
    return m == 0 ? 0.0 : std::sqrt(std::max(0.0, smallestEigenvalue(gram, m)));
}

void ArmNormal::damp(double lambda) noexcept {
    for (size_t i = 0; i < n_; ++i) {
        for (size_t j = 0; j < n_; ++j) {
            double sum = i == j ? lambda * lambda : 0.0;
            for (size_t k = 0; k < 6; ++k) {
                sum += columns_[i][k] * columns_[j][k];
            }
            metric_[i * n_ + j] = sum;
        }
    }
}

void ArmNormal::solve(const dvec3& a, const dvec3& scaledAlpha, JointVector& out) const noexcept {
    std::array<double, kMostJoints* kMostJoints> factor = metric_; // Cholesky, lower, in place
    JointVector x{};
    for (size_t i = 0; i < n_; ++i) {
        const auto& c = columns_[i];
        x[i] = c[0] * a.x + c[1] * a.y + c[2] * a.z + c[3] * scaledAlpha.x + c[4] * scaledAlpha.y +
               c[5] * scaledAlpha.z;
        for (size_t j = 0; j <= i; ++j) {
            double sum = factor[i * n_ + j];
            for (size_t k = 0; k < j; ++k) {
                sum -= factor[i * n_ + k] * factor[j * n_ + k];
            }
            factor[i * n_ + j] = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / factor[j * n_ + j];
        }
        for (size_t k = 0; k < i; ++k) {
            x[i] -= factor[i * n_ + k] * x[k];
        }
        x[i] /= factor[i * n_ + i];
    }
    for (size_t i = n_; i-- > 0;) {
        for (size_t k = i + 1; k < n_; ++k) {
            x[i] -= factor[k * n_ + i] * x[k];
        }
        x[i] /= factor[i * n_ + i];
    }
    out = x;
}

double dampingFor(double smallest, double below, double least, double most) noexcept {
    if (!(smallest < below)) {
        return least;
    }
    const double near = 1.0 - smallest / below;
    return std::max(least, most * near);
}

} // namespace fathom
