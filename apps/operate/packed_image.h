// SPDX-License-Identifier: Apache-2.0
// Images in less memory, without loss and at little processor time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fathom::operate {

// Each value as its difference from the one before: one byte for up to 63 units, two up to 8191, else three.
std::vector<uint8_t> packDepth(std::span<const uint16_t> depth);
// count: number of packed values.
std::vector<uint16_t> unpackDepth(std::span<const uint8_t> packed, size_t count);

// 0xAABBGGRR without A: three bytes per pixel, and less where neighbours are equal.
std::vector<uint8_t> packColour(std::span<const uint32_t> colour);
// A is 255.
std::vector<uint32_t> unpackColour(std::span<const uint8_t> packed, size_t count);

} // namespace fathom::operate
