// SPDX-License-Identifier: Apache-2.0
// Colour images of a recording folder: PNG or JPEG, by their first bytes.
#pragma once

#include "devices/recorded/png_image.h"

namespace fathom {

// Width and height; empty when the file is neither PNG nor JPEG.
std::optional<PngSize> colourImageSize(const std::filesystem::path& file);
// R8 G8 B8 A8 (0xAABBGGRR). Returns the fault, or empty when the file was read completely; a size other than
// `size` is a fault.
std::string readColourImage(const std::filesystem::path& file, PngSize size, std::span<uint32_t> target);

} // namespace fathom
