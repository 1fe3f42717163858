// SPDX-License-Identifier: Apache-2.0
// OpenEXR: scan lines, 16 or 32 bits of floating point, uncompressed, ZIP or ZIPS.
#pragma once

#include "devices/images/depth_header.h"

namespace fathom {

// True if the first bytes are those of OpenEXR.
bool isExr(ImageBytes bytes);
// Reads the header only.
DepthHeader exrHeader(ImageBytes bytes);
// Returns the fault, or empty when all was read. `out` has as many elements as exrHeader() states.
std::string readExr(ImageBytes bytes, std::span<float> out);

} // namespace fathom
