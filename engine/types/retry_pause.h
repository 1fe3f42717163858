// SPDX-License-Identifier: Apache-2.0
// Pauses between attempts to open a lost device.
#pragma once

#include <algorithm>
#include <utility>

namespace fathom {

// One thread.
class RetryPause {
public:
    // [s] of the pause before the next attempt: 0.1, 0.2, 0.4, ... 2.
    double next() noexcept { return std::exchange(pause_, std::min(2.0 * pause_, kLongest)); }
    // The next pause is the shortest again.
    void reset() noexcept { pause_ = kShortest; }

private:
    static constexpr double kShortest = 0.1, kLongest = 2.0; // [s]
    double pause_ = kShortest;
};

} // namespace fathom
