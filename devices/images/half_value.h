// SPDX-License-Identifier: Apache-2.0
// Numbers of 16 bits in EXR images and NPY arrays.
#pragma once

#include <cmath>
#include <cstdint>

namespace fathom {

// A number of IEEE 754 binary16, whose bits these are.
inline float halfValue(uint16_t bits) {
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const float size = exponent == 31  ? (mantissa == 0 ? HUGE_VALF : NAN)
                       : exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                                       : std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
    return (bits & 0x8000) != 0 ? -size : size;
}

} // namespace fathom
