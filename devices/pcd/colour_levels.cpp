// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/colour_levels.h"

#include <algorithm>

namespace fathom {

namespace {

// Levels of 0 to 255 per value; 0 = unknown.
double levelsPerValue(double largest, bool real) {
    if (real) {
        return largest <= 1.0 ? 255.0 : 1.0;
    }
    return largest <= 255.0 ? 1.0 : (largest <= 65535.0 ? 1.0 / 257.0 : 0.0);
}

} // namespace

std::vector<uint32_t> packColours(std::span<const std::array<double, 3>> colours, bool real,
                                  double& largest) {
    for (const auto& colour : colours) {
        for (const double value : colour) {
            largest = std::max(largest, value);
        }
    }
    const double scale = levelsPerValue(largest, real);
    std::vector<uint32_t> packed;
    if (scale == 0.0) {
        return packed;
    }
    packed.reserve(colours.size());
    for (const auto& colour : colours) {
        uint32_t levels = 0xff000000u;
        for (size_t c = 0; c < 3; ++c) {
            const double level = colour[c] * scale + 0.5;
            levels |= static_cast<uint32_t>(level > 0.0 ? std::min(255.0, level) : 0.0) << 8 * c;
        }
        packed.push_back(levels);
    }
    return packed;
}

} // namespace fathom
