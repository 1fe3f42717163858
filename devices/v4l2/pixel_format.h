// SPDX-License-Identifier: Apache-2.0
// From the pixels of a V4L2 buffer to those of a Frame. Sources: docs.kernel.org/userspace-api/media/v4l,
// pages pixfmt-z16, pixfmt-inzi, pixfmt-yuv-luma, pixfmt-packed-yuv, pixfmt-rgb.
#pragma once

#include "devices/v4l2/video_node.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace fathom {

// How the depth lies in a buffer of that format: 16-bit rows that can be used where they are, or not.
struct DepthLayout {
    uint32_t bitsPerPixel = 16; // of one row in memory
    uint32_t planesBefore = 0;  // pictures of the same size before it in the buffer (INZI: infrared)
    bool packed = false;        // 10 bits a pixel without gaps, most significant first (Y10B)
    uint16_t mask = 0xffff;     // bits that count

    // Bytes from row to row, where the driver says `stride`. Of INZI it tells the 32 bits a pixel that both
    // planes have together, while the rows of each lie without gaps.
    uint32_t rowBytes(uint32_t width, uint32_t stride) const;
};

// Empty: no depth can be in that format.
std::optional<DepthLayout> depthLayout(uint32_t fourcc);
// The formats that say depth by themselves, best first; then those that need to be asked for by name.
std::span<const uint32_t> declaredDepthFormats();
std::span<const uint32_t> colourFormats(); // best first: no loss, little work

// Bytes that a whole picture has; 0 for a compressed format.
size_t imageBytes(uint32_t fourcc, VideoSize size, uint32_t stride);

// The depth part as rows of 16 bits without gaps. bytes: at least imageBytes().
void unpackDepth(const DepthLayout& layout, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                 std::span<uint16_t> out);

// R8 G8 B8 A8 (0xAABBGGRR). YUYV and UYVY are BT.601, limited range, as UVC colour is unless told otherwise.
// Returns what is wrong; empty when it was converted whole.
std::string unpackColour(uint32_t fourcc, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                         std::span<uint32_t> out);

bool isYuyv(uint32_t fourcc); // YUYV or UYVY
// The same picture left packed, as words of YUYV (yuyv.h), rows without gaps. Of YUYV and UYVY of an even
// width. Returns as unpackColour().
std::string copyYuyv(uint32_t fourcc, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                     std::span<uint32_t> out);

} // namespace fathom
