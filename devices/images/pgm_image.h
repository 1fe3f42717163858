// SPDX-License-Identifier: Apache-2.0
// Binary PGM (P5) with 16 bits per pixel, most significant byte first (netpbm's pgm(5)). libfreenect's record
// and the raw images of NYU Depth have the least significant byte first.
#pragma once

#include "devices/images/byte_order.h"
#include "devices/images/depth_header.h"

namespace fathom {

// True if the first bytes are those of PGM.
bool isPgm(ImageBytes bytes);
// Refuses 8-bit images: a maximum value below 256.
DepthHeader pgmHeader(ImageBytes bytes);
// The values as stored; one above the stated maximum is a fault. Returns the fault, or empty when all were
// read. `out` has as many elements as pgmHeader() states.
std::string readPgm(ImageBytes bytes, std::span<uint16_t> out);
// Of a file with the least significant byte first.
std::string readSwappedPgm(ImageBytes bytes, std::span<uint16_t> out);
// By one image, whose values may not decide it. Throws nothing; of a damaged image it is Unknown.
ByteOrder pgmOrder(ImageBytes bytes);

} // namespace fathom
