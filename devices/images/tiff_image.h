// SPDX-License-Identifier: Apache-2.0
// TIFF with one channel, decoded by libtiff: 16-bit integers, or 32 or 64 bits of floating point, in strips.
#pragma once

#include "devices/images/depth_header.h"

namespace fathom {

// True if the first bytes are those of TIFF.
bool isTiff(ImageBytes bytes);
// The first image of the file. Uncompressed, LZW, PackBits or Deflate.
DepthHeader tiffHeader(ImageBytes bytes);
// Both return the fault, or empty when all was read. `out` has as many elements as tiffHeader() states, of
// the kind that it states.
std::string readTiff(ImageBytes bytes, std::span<uint16_t> out);
std::string readTiff(ImageBytes bytes, std::span<float> out);

} // namespace fathom
