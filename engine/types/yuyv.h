// SPDX-License-Identifier: Apache-2.0
// Colour as most USB cameras send it, 4:2:2 in BT.601's limited range, two pixels per word: Y0 | U << 8 |
// Y1 << 16 | V << 24.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace fathom {

// The word's two pixels, 0xAABBGGRR: BT.601 in steps of 1/256, rounded and cut to bytes.
// shaders/lib/yuyv.glsl makes the same bytes.
std::array<uint32_t, 2> rgbaOfYuyv(uint32_t word) noexcept;

// Rows of an even width, without gaps: rgba is twice as long as words.
void unpackYuyv(std::span<const uint32_t> words, std::span<uint32_t> rgba) noexcept;
// What a camera sends of those pixels: luma rounded, chroma of the mean of both. Alpha is lost.
void packYuyv(std::span<const uint32_t> rgba, std::span<uint32_t> words) noexcept;

} // namespace fathom
