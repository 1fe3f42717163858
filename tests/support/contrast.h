// SPDX-License-Identifier: Apache-2.0
// Contrast of colours by WCAG 2.1 (https://www.w3.org/TR/WCAG21/#dfn-contrast-ratio).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace fathom::testing {

// sRGB channels from 0 to 1.
using Rgb = std::array<double, 3>;

// From 0xAABBGGRR, without its alpha.
inline Rgb rgbOf(uint32_t colour) {
    return {(colour & 0xff) / 255.0, (colour >> 8 & 0xff) / 255.0, (colour >> 16 & 0xff) / 255.0};
}

// A colour 0xAABBGGRR drawn over another one.
inline Rgb blended(uint32_t over, const Rgb& under) {
    const double share = (over >> 24) / 255.0;
    const Rgb top = rgbOf(over);
    Rgb mixed{};
    for (size_t i = 0; i < 3; ++i) {
        mixed[i] = share * top[i] + (1.0 - share) * under[i];
    }
    return mixed;
}

inline double luminance(const Rgb& colour) {
    constexpr std::array kWeights{0.2126, 0.7152, 0.0722};
    double sum = 0.0;
    for (size_t i = 0; i < 3; ++i) {
        const double c = colour[i];
        sum += kWeights[i] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return sum;
}

// From 1 to 21.
inline double contrast(double a, double b) {
    return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

} // namespace fathom::testing
