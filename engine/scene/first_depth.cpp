// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/first_depth.h"

#include <algorithm>
#include <fmt/core.h>

namespace fathom {

// A few pixels in range do not count: edges in depth of a wrong unit have such.
void FirstDepth::look(std::span<const uint16_t> depth) noexcept {
    constexpr uint64_t kShare = 100; // one in so many measured pixels
    uint64_t measured = 0, within = 0;
    for (const uint16_t raw : depth) {
        if (seen_) {
            return;
        }
        if (raw != 0) {
            least_ = std::min(least_, raw);
            largest_ = std::max(largest_, raw);
            ++measured;
            within += raw * unit_ >= near_ && raw * unit_ <= far_ ? 1 : 0;
            seen_ = kShare * within >= depth.size();
        }
    }
    seen_ = seen_ || (within > 0 && kShare * within >= measured);
    measured_ += measured;
    within_ += within;
}

std::string FirstDepth::fault(std::string_view remedy) const {
    if (largest_ == 0) {
        return "no depth in the first second: nothing is protected";
    }
    const std::string part =
        within_ == 0 ? "no depth"
                     : fmt::format("only {:.2g} % of the depth",
                                   100.0 * static_cast<double>(within_) / static_cast<double>(measured_));
    return fmt::format(
        "{} of the first second is between camera.near {} m and camera.far {} m: {} is protected; it is "
        "{:.4g} to {:.4g} m, so check {} or near and far",
        part, near_, far_, within_ == 0 ? "nothing" : "hardly anything", least_ * unit_, largest_ * unit_,
        remedy);
}

} // namespace fathom
