// SPDX-License-Identifier: Apache-2.0
// The rows of the nearest-point problem, stored in blocks of eight, by column, so that one scan finds the
// most violated row. Rows are scaled by the metric's factor and to unit length: row . y >= bound, y = L^T x.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// Most unknowns of a problem: the six of a free tool, or the joints of an arm.
inline constexpr int kMaxUnknowns = 12;

// Lower Cholesky factor of the metric, row-major with kMaxUnknowns columns, and the reciprocals of its
// diagonal.
struct MetricFactor {
    std::array<double, kMaxUnknowns * kMaxUnknowns> lower{};
    std::array<double, kMaxUnknowns> inverseDiagonal{};
    bool diagonal = true; // nothing below the diagonal
};

// One thread. Allocates in the constructor only; everything else is noexcept.
class ConstraintRows {
public:
    static constexpr size_t kLanes = 8;

    ConstraintRows(int unknowns, size_t maxRows);

    void clear() noexcept;
    bool add(std::span<const double> normal, double offset) noexcept; // false when full
    void setOffset(size_t row, double offset) noexcept;
    double offset(size_t row) const noexcept { return raw_[rawAt(row, n_)]; }
    size_t size() const noexcept { return size_; }

    // Call when the metric changed: the next prepare() scales every row again.
    void forgetScaling() noexcept { scaledBlocks_ = 0; }
    // Scales the rows added since the last call. A row of zero length gets the bound +inf when its offset is
    // positive (no x satisfies it) and -inf otherwise; a row that is not finite gets +inf.
    void prepare(const MetricFactor& factor) noexcept;

    // Largest bound - row . y above tolerance (>= 0) over all rows, and the smallest index with that value;
    // row == size() when there is none. y has kMaxUnknowns finite numbers.
    struct Violation {
        double amount;
        size_t row;
    };
    Violation worst(const double* y, double tolerance) const noexcept;

    // After prepare(): the scaled unit row (kMaxUnknowns numbers), its bound, 1 / |L^-1 n| (0 for rows
    // without length).
    void unitRow(size_t row, double* out) const noexcept;
    double bound(size_t row) const noexcept { return scaled_[scaledAt(row, n_)]; }
    double inverseLength(size_t row) const noexcept { return scaled_[scaledAt(row, n_ + 1)]; }

private:
    size_t rawAt(size_t row, size_t column) const noexcept {
        return (row / kLanes * (n_ + 1) + column) * kLanes + row % kLanes;
    }
    size_t scaledAt(size_t row, size_t column) const noexcept {
        return (row / kLanes * (n_ + 2) + column) * kLanes + row % kLanes;
    }

    size_t n_;
    size_t maxRows_;
    size_t size_ = 0;
    size_t scaledBlocks_ = 0;
    std::vector<double> raw_;    // blocks of 8 rows: n columns, offsets
    std::vector<double> scaled_; // blocks of 8 rows: n columns of unit rows, bounds, inverse lengths
};

} // namespace fathom
