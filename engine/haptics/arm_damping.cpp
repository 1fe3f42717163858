// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_damping.h"

#include "engine/haptics/jacobi.h"

#include <algorithm>
#include <cmath>

namespace fathom {

double ArmNormal::smallestSingular(size_t rows) const noexcept {
    SquareMatrix<kMaxJoints> gram{};
    std::array<std::array<double, 6>, kMaxJoints> columns{};
    size_t count = 0;
    for (size_t k = 0; k < n_; ++k) {
        columns[count] = columns_[k];
        count += excluded_[k] ? 0 : 1;
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
    diagonalise(gram, m);
    double least = gram[0][0];
    for (size_t i = 1; i < m; ++i) {
        least = std::min(least, gram[i][i]);
    }
    return m == 0 ? 0.0 : std::sqrt(std::max(0.0, least));
}

std::array<std::array<double, kMaxJoints>, kMaxJoints> ArmNormal::gram() const noexcept {
    SquareMatrix<kMaxJoints> gram{};
    for (size_t i = 0; i < n_; ++i) {
        for (size_t j = 0; j < n_; ++j) {
            for (size_t k = 0; k < 6; ++k) {
                gram[i][j] += columns_[i][k] * columns_[j][k];
            }
        }
    }
    return gram;
}

void ArmNormal::gradient(const dvec3& a, const dvec3& scaledAlpha, JointVector& out) const noexcept {
    for (size_t i = 0; i < n_; ++i) {
        const auto& c = columns_[i];
        out[i] = c[0] * a.x + c[1] * a.y + c[2] * a.z + c[3] * scaledAlpha.x + c[4] * scaledAlpha.y +
                 c[5] * scaledAlpha.z;
    }
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
    std::array<double, kMaxJoints* kMaxJoints> factor = metric_; // Cholesky, lower, in place
    JointVector x{};
    gradient(a, scaledAlpha, x);
    for (size_t i = 0; i < n_; ++i) {
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
