// SPDX-License-Identifier: Apache-2.0
// Colour images of a recording folder: PNG or JPEG, by their first bytes.
#pragma once

#include "devices/recorded/png_image.h"
#include "engine/types/colour_format.h"

namespace fathom {

// Width and height; empty when the file is neither PNG nor JPEG.
std::optional<PngSize> colourImageSize(const std::filesystem::path& file);
// Rgba of a PNG, JpegPlanes of a JPEG.
ColourFormat colourImageFormat(const std::filesystem::path& file);
// To R8 G8 B8 A8 (0xAABBGGRR), or the planes of a JPEG, which `raw` then describes. target: room for
// mostColourBytes(). Returns the fault, or empty when the file was read completely; a size other than `size`
// is a fault.
std::string readColourImage(const std::filesystem::path& file, PngSize size, std::span<uint32_t> target,
                            RawColour& raw);

} // namespace fathom
