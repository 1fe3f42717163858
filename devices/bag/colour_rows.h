// SPDX-License-Identifier: Apache-2.0
// Uncompressed colour images of sensor_msgs/Image.
#pragma once

#include "devices/images/raw_image.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace fathom::ros {

// One encoding of sensor_msgs/image_encodings. Of channels with 16 bits the high byte is used.
struct ColourLayout {
    const char* encoding;
    uint32_t bytes = 0; // per pixel of a row
    // channel offsets [bytes]; Bayer: places of red and blue in a cell of 2 x 2
    std::array<uint8_t, 3> rgb = {};
    bool bayer = false;
    std::optional<RawKind> raw = {}; // the device unpacks it; else bytes and rgb count

    bool wide() const { return bayer ? bytes == 2 : bytes >= 6; } // channels of 16 bits
    bool grey() const { return !raw && !bayer && bytes == 1; }
};
// Null when the encoding is not colour. Upper and lower case are the same.
const ColourLayout* colourLayout(const std::string& encoding);

// The pixels of one message.
struct ColourImage {
    uint32_t width = 0, height = 0, step = 0; // [pixels], [bytes] per row
    std::span<const uint8_t> bytes;
    bool bigEndian = false; // channels of 16 bits
};
// To R8 G8 B8 A8, for layouts that the device does not unpack. Bayer images are interpolated bilinearly.
// Returns the fault, or empty when everything was converted.
std::string unpackColours(const ColourImage& image, const ColourLayout& layout, std::span<uint32_t> out);
// The same for the other layouts: copies them for the device (copyRaw).
std::string copyColours(const ColourImage& image, const ColourLayout& layout, std::span<std::byte> out,
                        RawColour& raw);

} // namespace fathom::ros
