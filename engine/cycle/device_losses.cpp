// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/device_losses.h"

#include <algorithm>

namespace fathom {

bool DeviceLosses::step(double time, bool present) noexcept {
    if (present_ && !present) {
        std::rotate(at_.begin(), at_.begin() + 1, at_.end());
        at_.back() = time;
    }
    present_ = present;
    const double since = time - at_.back();
    many_ = since < kCleanTime && (many_ || time - at_.front() < kCleanTime);
    return many_ || !present;
}

} // namespace fathom
