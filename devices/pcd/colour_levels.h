// SPDX-License-Identifier: Apache-2.0
// Colours of clouds whose red, green and blue are values of their own.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom {

// 0xAABBGGRR of red, green and blue, by the largest value of all: real ones are 0 to 1 or 0 to 255, whole
// ones 0 to 255 in any number of bytes, or 0 to 65535. Empty for larger whole numbers. largest: that of the
// clouds before, or 0; grows.
std::vector<uint32_t> packColours(std::span<const std::array<double, 3>> colours, bool real, double& largest);

} // namespace fathom
