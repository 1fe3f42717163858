// SPDX-License-Identifier: Apache-2.0
// YUYV, the colour format of most USB cameras: 4:2:2, BT.601 limited range, two pixels per word Y0 | U << 8 |
// Y1 << 16 | V << 24.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace fathom {

// Both pixels of a word as 0xAABBGGRR: BT.601 in steps of 1/256, rounded and clamped to bytes.
// shaders/lib/yuyv.glsl gives the same bytes.
std::array<uint32_t, 2> rgbaOfYuyv(uint32_t word) noexcept;

// Unpacks rows of even width without gaps; rgba is twice as long as words.
void unpackYuyv(std::span<const uint32_t> words, std::span<uint32_t> rgba) noexcept;
// Packs pixels as a camera does: luma rounded, chroma from the mean of two pixels. Drops alpha.
void packYuyv(std::span<const uint32_t> rgba, std::span<uint32_t> words) noexcept;

} // namespace fathom
