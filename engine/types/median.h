// SPDX-License-Identifier: Apache-2.0
// The value in the middle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fathom {

// The upper median; not of no values, nor of NaN. Changes their order.
template <class T>
T medianOf(std::vector<T>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace fathom
