// SPDX-License-Identifier: Apache-2.0
// Formats in which cameras send colour, and their conversion to red, green and blue. `classify` converts on
// the device; this is for readers on the host.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fathom {

// Rows without gaps, from the top left pixel. Y U V: BT.601. Limited range (luma 16..235) unless stated
// otherwise: the default of V4L2, docs.kernel.org/userspace-api/media/v4l/colorspaces-defs.html.
enum class ColourFormat : uint8_t {
    Rgba,   // R8 G8 B8 A8
    Yuyv,   // Y0 U Y1 V per two pixels; rows of an odd width end with a pair whose second pixel is outside
    Uyvy,   // U Y0 V Y1, likewise
    Rgb,    // R8 G8 B8
    Bgr,    // B8 G8 R8
    Planes, // luma, then chroma (ColourPlanes): NV12 and its relatives
    JpegPlanes, // the same with the full range 0..255: ITU-T T.871 (JFIF), the planes of a JPEG
};

// Places of luma and chroma in an image's bytes. The first four are multiples of four if the image's width
// is.
struct ColourPlanes {
    uint32_t lumaStep = 0;   // [bytes] from row to row
    uint32_t blue = 0;       // [bytes] place of the first U
    uint32_t red = 0;        // [bytes] place of the first V
    uint32_t chromaStep = 0; // [bytes] from row to row
    uint32_t across = 0;     // log2 of the columns that share a sample
    uint32_t down = 0;       // log2 of the rows that share a sample
    uint32_t apart = 0;      // log2 of the bytes from one U to the next in a row
};

// An image that is not Rgba.
struct RawColour {
    ColourFormat format = ColourFormat::Rgba; // Rgba: there is none
    uint32_t width = 0, height = 0;           // [pixels]
    std::span<const std::byte> bytes;
    ColourPlanes planes = {}; // of Planes and JpegPlanes

    uint64_t needed() const noexcept; // [bytes] that the format reads
};

// Name for messages: "YUYV".
const char* nameOf(ColourFormat format) noexcept;

// [bytes] of the largest image of this format: planes of a JPEG may be of any sampling, padded.
uint64_t mostColourBytes(ColourFormat format, uint32_t width, uint32_t height) noexcept;

// To 0xAABBGGRR, each pixel with the bytes that shaders/lib/raw_colour.glsl gives. A sample of chroma counts
// for all pixels that share it. `image` has needed() bytes, `rgba` a word per pixel.
void unpackColour(const RawColour& image, std::span<uint32_t> rgba) noexcept;
// The same of row y alone; `rgba` has a word per pixel of a row.
void unpackRow(const RawColour& image, uint32_t y, std::span<uint32_t> rgba) noexcept;

// Whether the image shows nothing, as when a lamp fails or an exposure goes wrong: of 16 rows, all but one
// pixel in a hundred have no channel above 16. An image without bytes is not dark.
bool isDark(const RawColour& image);

// Red, green and blue of one pixel as 0xffBBGGRR: BT.601, limited range, in steps of 1/256, rounded and
// clamped to bytes; and full range as libjpeg computes it, in steps of 1/65536.
uint32_t rgbaOfYuv(uint32_t y, uint32_t u, uint32_t v) noexcept;
uint32_t rgbaOfJpeg(uint32_t y, uint32_t u, uint32_t v) noexcept;

// Packs an even number of pixels to words Y0 | U << 8 | Y1 << 16 | V << 24, as a camera does: luma rounded,
// chroma from the mean of two pixels. Drops alpha.
void packYuyv(std::span<const uint32_t> rgba, std::span<uint32_t> words) noexcept;

} // namespace fathom
