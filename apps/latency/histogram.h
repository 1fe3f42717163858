// SPDX-License-Identifier: Apache-2.0
// A histogram of times in constant memory, one bin per microsecond, like cyclictest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fathom {

// One thread. Values in [us]. Negative values count as 0; values that are not finite are ignored.
class Histogram {
public:
    static constexpr size_t kBins = 20'000; // 20 ms; the last bin counts all larger values, max() stays exact

    Histogram()
        : bins_(kBins) {}

    void add(double micros) noexcept;

    uint64_t count() const { return count_; }
    double max() const { return max_; } // [us] the exact largest value; 0 when empty
    double mean() const;                // [us]; 0 when empty
    // [us] Upper edge of the bin that contains the value of rank ceil(share x count), at most max(). 0 when
    // empty.
    double percentile(double share) const;
    // Number of values in [from, to) [us]. If `to` is beyond the bins, all larger values count.
    uint64_t between(size_t from, size_t to) const;
    const std::vector<uint64_t>& bins() const { return bins_; }

private:
    std::vector<uint64_t> bins_; // bin i: [i, i + 1) us
    uint64_t count_ = 0;
    double sum_ = 0.0, max_ = 0.0;
};

} // namespace fathom
