// SPDX-License-Identifier: Apache-2.0
// Converts the pixels of a V4L2 buffer to those of a Frame. Sources: docs.kernel.org/userspace-api/media/v4l,
// pages pixfmt-z16, pixfmt-inzi, pixfmt-yuv-luma, and those of devices/images/raw_image.h.
#pragma once

#include "devices/v4l2/video_node.h"
#include "engine/types/colour_format.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace fathom {

// Layout of depth in a buffer of that format: 16-bit rows that are usable in place, or not.
struct DepthLayout {
    uint32_t bitsPerPixel = 16; // of one row in memory
    uint32_t planesBefore = 0;  // images of the same size before it in the buffer (INZI: infrared)
    bool packed = false;        // 10 bits per pixel without gaps, most significant first (Y10B)
    uint16_t mask = 0xffff;     // significant bits

    // Bytes from row to row, given the driver's `stride`. For INZI the driver reports 32 bits per pixel for
    // both planes together, while the rows of each plane have no gaps.
    uint32_t rowBytes(uint32_t width, uint32_t stride) const;
};

// Empty: the format cannot contain depth.
std::optional<DepthLayout> depthLayout(uint32_t fourcc);
// First the formats that are always depth, best first; then those that must be requested by name.
std::span<const uint32_t> declaredDepthFormats();
std::span<const uint32_t> colourFormats(); // best first: lossless, cheap

// Bytes of a complete image; 0 for a compressed format.
size_t imageBytes(uint32_t fourcc, VideoSize size, uint32_t stride);

// Copies the depth part to 16-bit rows without gaps. bytes: at least imageBytes().
void unpackDepth(const DepthLayout& layout, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                 std::span<uint16_t> out);

ColourFormat colourFormatOf(uint32_t fourcc); // of colourFormats()
// Copies the image as the camera sends it, rows without gaps; of a JPEG its planes. out: room for
// mostColourBytes(). Returns the fault; empty when `raw` describes the copy.
std::string copyColour(uint32_t fourcc, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                       std::span<std::byte> out, RawColour& raw);

} // namespace fathom
