// SPDX-License-Identifier: Apache-2.0
// Uncompressed colour images of sensor_msgs/Image to R8 G8 B8 A8.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace fathom::ros {

// How a row holds its pixels.
enum class Packing : uint8_t { Plain, Uyvy, Yuyv, Nv12, Nv21, I420, Yv12, Bayer };

// One encoding of sensor_msgs/image_encodings. Of channels with 16 bits the high byte is used.
struct ColourLayout {
    const char* encoding;
    uint32_t bytes;             // per pixel of a row
    std::array<uint8_t, 3> rgb; // channel offsets [bytes]; Bayer: places of red and blue in a cell of 2 x 2
    Packing packing = Packing::Plain;

    bool wide() const { // channels of 16 bits
        return (packing == Packing::Plain && bytes >= 6) || (packing == Packing::Bayer && bytes == 2);
    }
    bool grey() const { return packing == Packing::Plain && bytes == 1; }
    bool planar() const { // chroma of 2 x 2 pixels behind the luma
        return packing == Packing::Nv12 || packing == Packing::Nv21 || packing == Packing::I420 ||
               packing == Packing::Yv12;
    }
    bool interleaved() const { return packing == Packing::Nv12 || packing == Packing::Nv21; }
};
// Null when the encoding is not colour. Upper and lower case are the same.
const ColourLayout* colourLayout(std::string encoding);

// The pixels of one message.
struct ColourImage {
    uint32_t width = 0, height = 0, step = 0; // [pixels], [bytes] per row
    std::span<const uint8_t> bytes;
    bool bigEndian = false; // channels of 16 bits
};
// YUV is BT.601, limited range; Bayer images are interpolated bilinearly. Returns the fault, or empty when
// everything was converted.
std::string unpackColours(const ColourImage& image, const ColourLayout& layout, std::span<uint32_t> out);

} // namespace fathom::ros
