// SPDX-License-Identifier: Apache-2.0
// What the first bytes of a depth image state.
#pragma once

#include "devices/recorded/png_image.h"

#include <span>
#include <string>

namespace fathom {

// Size and kind of the values. Where `fault` says why the image cannot be read, the rest may be unset.
struct DepthHeader {
    PngSize size;
    bool metres = false; // floating point, else the 16-bit values of a sensor
    std::string fault;
};

// The whole content of an image file.
using ImageBytes = std::span<const uint8_t>;

} // namespace fathom
