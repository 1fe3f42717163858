// SPDX-License-Identifier: Apache-2.0
// Uncompressed images as drivers and recordings hold them, copied to rows without gaps (RawColour).
#pragma once

#include "engine/types/colour_format.h"

#include <string>

namespace fathom {

// Order of the bytes. The last four have a plane of luma, then chroma for every 2 x 2 pixels, in
// pairs or in two planes. Sources: docs.kernel.org/userspace-api/media/v4l, pages pixfmt-rgb,
// pixfmt-packed-yuv, pixfmt-yuv-planar.
enum class RawKind : uint8_t { Rgb, Bgr, Yuyv, Uyvy, Nv12, Nv21, I420, Yv12 };

// The format with which the device unpacks it.
ColourFormat formatOf(RawKind kind);

// step: [bytes] from row to row of luma, or of the only plane; planes of chroma alone have half of it. 0 = no
// gaps.
struct RawImage {
    RawKind kind = RawKind::Rgb;
    uint32_t width = 0, height = 0, step = 0;
    std::span<const std::byte> bytes;
};

// [bytes] up to the last pixel; 0: no pixels, or rows shorter than the width.
size_t neededBytes(const RawImage& image);

// out: room for mostColourBytes(). Returns the fault; empty when `raw` describes the copy in `out`.
std::string copyRaw(const RawImage& image, std::span<std::byte> out, RawColour& raw);

} // namespace fathom
