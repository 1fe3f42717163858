// SPDX-License-Identifier: Apache-2.0
// IEEE half precision in integer arithmetic. Supports finite numbers up to 65504, zero and denormals, but not
// infinity or NaN.
#pragma once

#include <bit>
#include <cstdint>

namespace fathom::profile {

// Converts to single precision exactly, with a shift and a multiplication.
inline float widened(uint16_t half) noexcept {
    const uint32_t bits =
        (static_cast<uint32_t>(half & 0x8000u) << 16) | (static_cast<uint32_t>(half & 0x7fffu) << 13);
    return std::bit_cast<float>(bits) * 0x1p112f;
}

// Rounds to nearest, ties to even.
inline uint16_t halved(float value) noexcept {
    const uint32_t bits = std::bit_cast<uint32_t>(value * 0x1p-112f), body = bits & 0x7fffffffu;
    return static_cast<uint16_t>((bits >> 16 & 0x8000u) | ((body + 0xfffu + (body >> 13 & 1u)) >> 13));
}

// Rounds a value >= 0 up to the next half-precision number.
inline uint16_t halvedUp(double value) noexcept {
    uint16_t half = halved(static_cast<float>(value));
    while (static_cast<double>(widened(half)) < value) {
        ++half;
    }
    return half;
}

} // namespace fathom::profile
