// SPDX-License-Identifier: Apache-2.0
// Which hues the colour images hold, to choose the gates of a class by.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <span>

namespace fathom {

// Counts pixels whose colour is clear enough for a hue: saturation of at least kMinSaturation, lightness of
// kDark to kBright, all HSL as the classes use them.
class HueStudy {
public:
    static constexpr size_t kHues = 24; // bars of 15 degrees, the first around 0
    static constexpr double kMinSaturation = 0.15, kDark = 0.05, kBright = 0.95;

    void add(std::span<const uint32_t> colours); // 0xAABBGGRR
    uint64_t count(size_t bar) const { return bars_[bar].count; }
    uint64_t clear() const; // counted pixels
    // One row per bar with enough pixels for a class: its hues, the bar, and the saturation and lightness of
    // four fifths of its pixels.
    void write(std::ostream& out) const;

private:
    static constexpr size_t kLevels = 50;
    using Levels = std::array<uint64_t, kLevels>; // of 0 to 1
    struct Bar {
        uint64_t count = 0;
        Levels saturation{}, lightness{};
    };
    std::array<Bar, kHues> bars_{};
    uint64_t all_ = 0;
};

} // namespace fathom
