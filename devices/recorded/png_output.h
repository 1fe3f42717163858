// SPDX-License-Identifier: Apache-2.0
// PNG images written by libpng, fast and lossless.
#pragma once

#include "devices/recorded/png_image.h"

namespace fathom {

// Both write a new file completely or throw Error naming it, also when it exists. pixels: size.width x
// size.height.
void writeDepthPng(const std::filesystem::path& file, PngSize size, std::span<const uint16_t> pixels);
// R8 G8 B8 A8 (0xAABBGGRR) to 8-bit RGB.
void writeColourPng(const std::filesystem::path& file, PngSize size, std::span<const uint32_t> pixels);

} // namespace fathom
