// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/first_depth.h"

#include <algorithm>
#include <fmt/core.h>

namespace fathom {

void FirstDepth::look(std::span<const uint16_t> depth) noexcept {
    for (const uint16_t raw : depth) {
        if (seen_) {
            return;
        }
        if (raw != 0) {
            least_ = std::min(least_, raw);
            largest_ = std::max(largest_, raw);
            seen_ = raw * unit_ >= near_ && raw * unit_ <= far_;
        }
    }
}

std::string FirstDepth::fault(std::string_view remedy) const {
    return largest_ == 0
               ? "no depth in the first second: nothing is protected"
               : fmt::format("no depth of the first second is between camera.near {} m and camera.far {} m: "
                             "nothing is protected; it is {:.4g} to {:.4g} m, so check {} or near and far",
                             near_, far_, least_ * unit_, largest_ * unit_, remedy);
}

} // namespace fathom
