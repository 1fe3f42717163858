// SPDX-License-Identifier: Apache-2.0
// Times of a long run in a fixed amount of memory: a bin a microsecond, as cyclictest counts them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fathom {

// One thread. Values are [us]; less than 0 counts as 0, what is not finite is left out.
class Histogram {
public:
    static constexpr size_t kBins =
        20'000; // up to 20 ms; what is over lies in the last one, max() stays exact

    Histogram()
        : bins_(kBins) {}

    void add(double micros) noexcept;

    uint64_t count() const { return count_; }
    double max() const { return max_; } // [us] the largest value itself; 0 when there is none
    double mean() const;                // [us]; 0 when there is none
    // [us] where the bin ends that holds the value of rank ceil(share x count); never more than max(). 0 when
    // there is none.
    double percentile(double share) const;
    // Values in [from, to) [us]; to beyond the bins counts all that is over.
    uint64_t between(size_t from, size_t to) const;
    const std::vector<uint64_t>& bins() const { return bins_; }

private:
    std::vector<uint64_t> bins_; // bin i: [i, i + 1) us
    uint64_t count_ = 0;
    double sum_ = 0.0, max_ = 0.0;
};

} // namespace fathom
