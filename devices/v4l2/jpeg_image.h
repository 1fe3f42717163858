// SPDX-License-Identifier: Apache-2.0
// Decodes one JPEG with libjpeg-turbo. The device converts its planes to red, green and blue.
#pragma once

#include "devices/v4l2/video_node.h"
#include "engine/types/colour_format.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace fathom {

// Decodes luma and chroma as they are stored, in any sampling; grey images get chroma without colour. out:
// room for mostColourBytes() of JpegPlanes. Returns the fault; empty when `raw` describes the planes in
// `out`. A size other than `size`, and colours that are not Y Cb Cr, are faults. Any thread.
std::string readJpeg(std::span<const std::byte> bytes, VideoSize size, std::span<std::byte> out,
                     RawColour& raw);

// By the first bytes.
bool isJpeg(std::span<const std::byte> bytes);
// What the header of a JPEG states; empty when it cannot be read.
struct JpegHeader {
    VideoSize size;
    bool grey = false; // one component
};
std::optional<JpegHeader> jpegHeader(std::span<const std::byte> bytes);

} // namespace fathom
