// SPDX-License-Identifier: Apache-2.0
// Eigenvalues of small symmetric matrices by cyclic Jacobi rotations (Golub and Van Loan, Matrix
// Computations, section 8.5).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace fathom {

// An off-diagonal element this small relative to the diagonal does not change the eigenvalues in float64.
// Relative criterion for a Gram matrix: Demmel and Veselic, "Jacobi's method is more accurate than QR", 1992.
inline constexpr double kRotated2 = 1e-34; // squared

// The first m rows and columns are in use.
template <size_t kMax>
using SquareMatrix = std::array<std::array<double, kMax>, kMax>;

// Turns the symmetric m x m matrix into one whose diagonal holds the eigenvalues. vectors: null, or the
// identity, whose columns become the eigenvectors. No allocation.
template <size_t kMax>
void diagonalise(SquareMatrix<kMax>& a, size_t m, SquareMatrix<kMax>* vectors = nullptr) noexcept {
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
                const auto turn = [&](double& ip, double& iq) {
                    const double before = ip;
                    ip = c * before - s * iq;
                    iq = s * before + c * iq;
                };
                for (size_t i = 0; i < m; ++i) {
                    turn(a[i][p], a[i][q]);
                }
                for (size_t i = 0; i < m; ++i) {
                    turn(a[p][i], a[q][i]);
                    if (vectors != nullptr) {
                        turn((*vectors)[i][p], (*vectors)[i][q]);
                    }
                }
            }
        }
    }
}

} // namespace fathom
