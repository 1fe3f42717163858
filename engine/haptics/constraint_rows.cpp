// SPDX-License-Identifier: Apache-2.0
// The two loops over all rows. They are compiled for several instruction sets and chosen at run time; every
// lane multiplies and subtracts in the same order, so results are identical to the bit.
#include "engine/haptics/constraint_rows.h"

#include "engine/contact/clones.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace fathom {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr size_t kLanes = ConstraintRows::kLanes;
constexpr double kLongestInverse = 1e140; // a row shorter than 1e-140 has no direction left

// 1 or 0 by integer arithmetic, which vectorises where comparing doubles would branch.
inline uint64_t notFinite(double v) noexcept {
    const uint64_t magnitude = std::bit_cast<uint64_t>(v) & 0x7fffffffffffffffu;
    return (magnitude + 0x0010000000000000u) >> 63; // the exponent of inf and NaN carries into the top bit
}
inline uint64_t tooShort(double squaredLength) noexcept {
    constexpr uint64_t kShortest = std::bit_cast<uint64_t>(1.0 / (kLongestInverse * kLongestInverse));
    return (std::bit_cast<uint64_t>(squaredLength) - kShortest) >> 63;
}

// Forward substitution L g = n, then unit length, for eight rows at once. N is a compile-time constant so
// that the compiler unrolls the columns and vectorises over the eight rows, which works when the factor is
// diagonal (as for the free tool). False when a lane needs fixLanes(). Layout of raw and scaled: see the
// class.
template <size_t N, bool kDiagonal>
[[gnu::always_inline]] inline bool scaleLanes(const double* __restrict raw, double* __restrict scaled,
                                              const MetricFactor& factor) noexcept {
    double inverseDiagonal[N];
    for (size_t j = 0; j < N; ++j) {
        inverseDiagonal[j] = factor.inverseDiagonal[j];
    }
    uint64_t odd = 0;
    for (size_t l = 0; l < kLanes; ++l) {
        double g[N];
        double squared = 0.0;
        for (size_t j = 0; j < N; ++j) {
            g[j] = raw[j * kLanes + l];
            if constexpr (!kDiagonal) {
                for (size_t i = 0; i < j; ++i) {
                    g[j] -= factor.lower[j * kMaxUnknowns + i] * g[i];
                }
            }
            g[j] *= inverseDiagonal[j];
            squared += g[j] * g[j];
        }
        const double inverse = 1.0 / std::sqrt(squared);
        const double bound = raw[N * kLanes + l] * inverse;
        for (size_t j = 0; j < N; ++j) {
            scaled[j * kLanes + l] = g[j] * inverse;
        }
        scaled[N * kLanes + l] = bound;
        scaled[(N + 1) * kLanes + l] = inverse;
        odd |= tooShort(squared) | notFinite(squared) | notFinite(bound);
    }
    return odd == 0;
}

// Lanes without a direction or with a number that is not finite. A row that no x satisfies must not be lost.
void fixLanes(const double* raw, double* scaled, size_t n) noexcept {
    for (size_t l = 0; l < kLanes; ++l) {
        const double inverse = scaled[(n + 1) * kLanes + l];
        if (inverse > 0.0 && inverse <= kLongestInverse && std::isfinite(scaled[n * kLanes + l])) {
            continue;
        }
        const bool harmless = raw[n * kLanes + l] <= 0.0 && inverse > 0.0; // false for every NaN
        for (size_t j = 0; j < n + 2; ++j) {
            scaled[j * kLanes + l] = 0.0;
        }
        scaled[n * kLanes + l] = harmless ? -kNoLimit : kNoLimit;
    }
}

// Bits of doubles >= +0, which sort like integers. Integer compares need no branch to keep the exception
// flags right.
struct LaneWorst {
    alignas(64) std::array<int64_t, kLanes> amount;
    alignas(64) std::array<int64_t, kLanes> block;
};

// Per lane, the largest violation above the initial `worst`, and the first block with it.
template <size_t N>
[[gnu::always_inline]] inline void scanLanes(const double* __restrict scaled, const double* __restrict point,
                                             size_t blocks, LaneWorst& worst) noexcept {
    double y[N];
    for (size_t j = 0; j < N; ++j) {
        y[j] = point[j];
    }
    alignas(64) std::array<int64_t, kLanes> amount = worst.amount, block = worst.block;
    for (size_t b = 0; b < blocks; ++b) {
        for (size_t l = 0; l < kLanes; ++l) {
            double v = scaled[(b * (N + 2) + N) * kLanes + l];
            for (size_t j = 0; j < N; ++j) {
                v -= scaled[(b * (N + 2) + j) * kLanes + l] * y[j];
            }
            const int64_t bits = std::bit_cast<int64_t>(v);
            const int64_t before = amount[l];
            block[l] = bits > before ? static_cast<int64_t>(b) : block[l];
            amount[l] = bits > before ? bits : before;
        }
    }
    worst = {amount, block};
}

template <size_t N>
inline void putLane(double* lane, const double* normal, double offset) noexcept {
    for (size_t j = 0; j < N; ++j) {
        lane[j * kLanes] = normal[j];
    }
    lane[N * kLanes] = offset;
}

#define FATHOM_FOR_UNKNOWNS(n, CALL)                                                                         \
    switch (n) {                                                                                             \
    case 1:                                                                                                  \
        CALL(1);                                                                                             \
        break;                                                                                               \
    case 2:                                                                                                  \
        CALL(2);                                                                                             \
        break;                                                                                               \
    case 3:                                                                                                  \
        CALL(3);                                                                                             \
        break;                                                                                               \
    case 4:                                                                                                  \
        CALL(4);                                                                                             \
        break;                                                                                               \
    case 5:                                                                                                  \
        CALL(5);                                                                                             \
        break;                                                                                               \
    case 6:                                                                                                  \
        CALL(6);                                                                                             \
        break;                                                                                               \
    case 7:                                                                                                  \
        CALL(7);                                                                                             \
        break;                                                                                               \
    case 8:                                                                                                  \
        CALL(8);                                                                                             \
        break;                                                                                               \
    case 9:                                                                                                  \
        CALL(9);                                                                                             \
        break;                                                                                               \
    case 10:                                                                                                 \
        CALL(10);                                                                                            \
        break;                                                                                               \
    case 11:                                                                                                 \
        CALL(11);                                                                                            \
        break;                                                                                               \
    default:                                                                                                 \
        CALL(12);                                                                                            \
        break;                                                                                               \
    }

FATHOM_CLONES bool scaleBlock(const double* raw, double* scaled, const MetricFactor& factor,
                              size_t n) noexcept {
#define FATHOM_SCALE(N)                                                                                      \
    return factor.diagonal ? scaleLanes<N, true>(raw, scaled, factor)                                        \
                           : scaleLanes<N, false>(raw, scaled, factor)
    FATHOM_FOR_UNKNOWNS(n, FATHOM_SCALE)}

FATHOM_CLONES void scanBlocks(const double* scaled, const double* y, size_t n, size_t blocks,
                              LaneWorst& worst) noexcept {
#define FATHOM_SCAN(N) scanLanes<N>(scaled, y, blocks, worst)
    FATHOM_FOR_UNKNOWNS(n, FATHOM_SCAN)
}

} // namespace

ConstraintRows::ConstraintRows(int unknowns, size_t maxRows)
    : n_(static_cast<size_t>(unknowns))
    , maxRows_(maxRows) {
    const size_t padded = (maxRows + kLanes - 1) / kLanes * kLanes;
    raw_.resize(padded * (n_ + 1));
    scaled_.resize(padded * (n_ + 2));
}

void ConstraintRows::clear() noexcept {
    size_ = 0;
    scaledBlocks_ = 0;
}

// Not inlined: for a caller whose row is an array of 7, GCC would warn about more unknowns, which cannot
// occur there.
[[gnu::noinline]] bool ConstraintRows::add(std::span<const double> normal, double offset) noexcept {
    if (size_ == maxRows_) {
        return false;
    }
    double* raw = &raw_[rawAt(size_, 0)];
    if (size_ % kLanes == 0) { // lanes without a row must never be the worst
        std::fill_n(raw, n_ * kLanes, 0.0);
        std::fill_n(raw + n_ * kLanes, kLanes, -1.0);
    }
#define FATHOM_PUT(N) putLane<N>(raw, normal.data(), offset)
    FATHOM_FOR_UNKNOWNS(n_, FATHOM_PUT)
    scaledBlocks_ = std::min(scaledBlocks_, size_ / kLanes);
    ++size_;
    return true;
}

void ConstraintRows::setOffset(size_t row, double offset) noexcept {
    raw_[rawAt(row, n_)] = offset;
    const double bound = offset * inverseLength(row);
    if (row / kLanes < scaledBlocks_ && inverseLength(row) > 0.0 && std::isfinite(bound)) {
        scaled_[scaledAt(row, n_)] = bound;
    } else {
        scaledBlocks_ = std::min(scaledBlocks_, row / kLanes);
    }
}

void ConstraintRows::prepare(const MetricFactor& factor) noexcept {
    const size_t blocks = (size_ + kLanes - 1) / kLanes;
    for (size_t b = scaledBlocks_; b < blocks; ++b) {
        const double* raw = &raw_[rawAt(b * kLanes, 0)];
        double* scaled = &scaled_[scaledAt(b * kLanes, 0)];
        if (!scaleBlock(raw, scaled, factor, n_)) {
            fixLanes(raw, scaled, n_);
        }
    }
    scaledBlocks_ = blocks;
}

ConstraintRows::Violation ConstraintRows::worst(const double* y, double tolerance) const noexcept {
    LaneWorst lanes;
    lanes.amount.fill(std::bit_cast<int64_t>(tolerance));
    lanes.block.fill(0);
    scanBlocks(scaled_.data(), y, n_, (size_ + kLanes - 1) / kLanes, lanes);
    Violation worst{tolerance, size_};
    for (size_t l = 0; l < kLanes; ++l) {
        const double amount = std::bit_cast<double>(lanes.amount[l]);
        const size_t row = static_cast<size_t>(lanes.block[l]) * kLanes + l;
        if (amount > tolerance && (amount > worst.amount || (amount == worst.amount && row < worst.row))) {
            worst = {amount, row};
        }
    }
    return worst;
}

void ConstraintRows::unitRow(size_t row, double* out) const noexcept {
    std::fill_n(out, kMaxUnknowns, 0.0);
    for (size_t j = 0; j < n_; ++j) {
        out[j] = scaled_[scaledAt(row, j)];
    }
}

} // namespace fathom
