// SPDX-License-Identifier: Apache-2.0
// Colours as a camera of another format sends them.
#pragma once

#include "engine/types/colour_format.h"

#include <vector>

namespace fathom::verify {

// An image with its own bytes.
struct PackedColour {
    std::vector<std::byte> bytes;
    RawColour layout; // without bytes

    RawColour image() const {
        RawColour all = layout;
        all.bytes = bytes;
        return all;
    }
};

// rgba: 0xAABBGGRR, width x height; alpha is dropped. Samples of chroma are means of the pixels that share
// them: Planes are NV12, JpegPlanes 4:2:2, as in most motion JPEG.
PackedColour packColour(ColourFormat format, uint32_t width, uint32_t height, std::span<const uint32_t> rgba);

} // namespace fathom::verify
