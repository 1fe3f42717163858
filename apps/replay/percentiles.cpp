// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/percentiles.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace fathom {

namespace {

// The double nearest to the shortest decimal text of the float, so that 12.3f is reported as 12.3.
double shortest(float value) {
    char digits[40];
    const auto written = std::to_chars(digits, digits + sizeof digits, value);
    double result = double{value};
    std::from_chars(digits, written.ptr, result);
    return result;
}

double ofRank(std::vector<float>& values, uint64_t perMille) {
    const uint64_t rank = std::max<uint64_t>(1, (perMille * values.size() + 999) / 1000);
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(values.begin(), place, values.end());
    return shortest(*place);
}

} // namespace

Percentiles percentilesOf(std::vector<float> values) {
    std::erase_if(values, [](float value) { return !std::isfinite(value); });
    if (values.empty()) {
        return {};
    }
    return {ofRank(values, 500), ofRank(values, 990), ofRank(values, 999), ofRank(values, 1000)};
}

} // namespace fathom
