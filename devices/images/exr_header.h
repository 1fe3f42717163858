// SPDX-License-Identifier: Apache-2.0
// The header of an OpenEXR file with one part of scan lines. Source: "OpenEXR File Layout" of the project.
#pragma once

#include "devices/images/depth_header.h"

#include <vector>

namespace fathom {

struct ExrHeader {
    uint32_t width = 0, height = 0;
    size_t rowBytes = 0;         // of all channels
    size_t channelAt = 0;        // [bytes] in a row, where depth begins
    std::vector<size_t> equalAt; // [bytes] in a row, where channels begin that equal depth, or are 0
    bool half = false;           // depth has 16 bits per pixel, else 32
    uint32_t rowsPerChunk = 1;   // 1 or 16
    bool packed = false;         // zlib
    std::vector<size_t> chunks;  // where each begins in the file
    int32_t firstRow = 0;
    std::string fault; // names the field, its value and what is allowed; empty = all above is set
};

// At most 64 channels and images of at most 3840x2160. chooseExrDepth() says which channel is depth.
ExrHeader parseExrHeader(ImageBytes bytes);

} // namespace fathom
