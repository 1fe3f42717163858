// SPDX-License-Identifier: Apache-2.0
// Exact percentiles by nearest rank.
#pragma once

#include <optional>
#include <vector>

namespace fathom {

// In the unit of the values; empty when there was none.
struct Percentiles {
    std::optional<double> p50, p99, p999, max;
};

// Nearest rank: the p-th percentile of n values is the one of rank ceil(p n), counted from 1 in ascending
// order: always a value that occurred. Values that are not finite are left out. Takes the vector over and
// reorders it.
Percentiles percentilesOf(std::vector<float> values);

} // namespace fathom
