// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_tick.h"

#include "engine/types/clock.h"

#include <algorithm>

namespace fathom {

bool MessagePace::due(double t) noexcept {
    next_ = t < last_ ? t : next_;
    last_ = t;
    if (t < next_ - kSlack) {
        return false;
    }
    next_ = std::max(next_ + period_, t);
    return true;
}

uint64_t TickStamps::at(double t) noexcept {
    const double now = monotonicSeconds();
    const uint64_t utc = utcNanoseconds();
    zero_ = any_ && t >= last_ ? std::min(zero_, now - t) : now - t;
    last_ = t;
    any_ = true;
    const auto age = static_cast<int64_t>(1e9 * (now - t - zero_));
    return utc - static_cast<uint64_t>(age);
}

} // namespace fathom
