// SPDX-License-Identifier: Apache-2.0
// Exact percentiles by nearest rank.
#pragma once

#include <optional>
#include <vector>

namespace fathom {

// In the unit of the values; empty when there were no values.
struct Percentiles {
    std::optional<double> p50, p99, p999, max;
};

// Nearest rank: the p-th percentile of n values is the value of rank ceil(p n) in ascending order, counted
// from 1, so it is always one of the values. Ignores values that are not finite. Consumes the vector.
Percentiles percentilesOf(std::vector<float> values);

} // namespace fathom
