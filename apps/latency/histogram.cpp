// SPDX-License-Identifier: Apache-2.0
#include "apps/latency/histogram.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom {

void Histogram::add(double micros) noexcept {
    if (!std::isfinite(micros)) {
        return;
    }
    micros = std::max(0.0, micros);
    ++bins_[std::min(kBins - 1, static_cast<size_t>(std::min(micros, 1e9)))];
    ++count_;
    sum_ += micros;
    max_ = std::max(max_, micros);
}

double Histogram::mean() const {
    return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_);
}

double Histogram::percentile(double share) const {
    const auto rank =
        static_cast<uint64_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count_)));
    uint64_t seen = 0;
    for (size_t i = 0; i + 1 < kBins; ++i) {
        seen += bins_[i];
        if (seen >= std::max<uint64_t>(rank, 1)) {
            return std::min(static_cast<double>(i + 1), max_);
        }
    }
    return max_;
}

uint64_t Histogram::between(size_t from, size_t to) const {
    const auto end = bins_.begin() + static_cast<long>(std::min(to, kBins));
    return std::accumulate(bins_.begin() + static_cast<long>(std::min(from, kBins)), end, uint64_t{0});
}

} // namespace fathom
