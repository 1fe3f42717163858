// SPDX-License-Identifier: Apache-2.0
// Tells a clock that was set back within a recording from single stamps that go back.
#pragma once

#include <cmath>
#include <cstddef>

namespace fathom {

// Whether the stamps [s] from `index` on, stampOf(i) for i < end, are those of a clock that was set back
// after `last`: five that follow each other are earlier. Stamps of damaged images are infinite and do not
// count.
template <class StampOf>
bool isSetBack(double last, size_t index, size_t end, StampOf&& stampOf) {
    constexpr size_t kInARow = 5, kLooked = 20; // images
    size_t earlier = 0;
    for (size_t i = index; i < end && i < index + kLooked && earlier < kInARow; ++i) {
        const double stamp = stampOf(i);
        if (std::isfinite(stamp) && stamp >= last) {
            return false;
        }
        earlier += std::isfinite(stamp) ? 1 : 0;
    }
    return earlier == kInARow;
}

} // namespace fathom
