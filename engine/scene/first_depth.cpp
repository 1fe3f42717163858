// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/first_depth.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/core.h>

namespace fathom {

bool FirstDepth::inRange(uint16_t raw) const noexcept {
    return raw * unit_ >= near_ && raw * unit_ <= far_;
}

// In range with the pixels to the right and below, at nearly the same depth. Depth of a wrong unit is in
// range at edges only: these are one pixel wide, or steep.
bool FirstDepth::onSurface(std::span<const uint16_t> depth, size_t pixel) const noexcept {
    constexpr int kSteep = 32; // one in so many parts of the depth from pixel to pixel
    if (pixel % width_ + 1 == width_ || pixel + width_ >= depth.size()) {
        return false;
    }
    const int own = depth[pixel];
    const auto continues = [&](uint16_t other) {
        return inRange(other) && std::abs(other - own) <= std::max(1, own / kSteep);
    };
    return continues(depth[pixel + 1]) && continues(depth[pixel + width_]);
}

// A few pixels in range do not count, unless they are a small object in front of a far room.
void FirstDepth::look(std::span<const uint16_t> depth) noexcept {
    constexpr uint64_t kShare = 100, kSurfaceShare = 10'000; // one in so many measured pixels
    constexpr uint64_t kLeastSurface = 8;                    // pixels
    uint64_t measured = 0, within = 0, surface = 0;
    const auto enough = [&](uint64_t of) {
        return within > 0 &&
               (kShare * within >= of || (surface >= kLeastSurface && kSurfaceShare * surface >= of));
    };
    for (size_t i = 0; i < depth.size(); ++i) {
        if (seen_) {
            return;
        }
        const uint16_t raw = depth[i];
        if (raw != 0) {
            least_ = std::min(least_, raw);
            largest_ = std::max(largest_, raw);
            ++measured;
            if (inRange(raw)) {
                ++within;
                surface += onSurface(depth, i) ? 1 : 0;
                seen_ = enough(depth.size());
            }
        }
    }
    seen_ = seen_ || enough(measured);
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
