// SPDX-License-Identifier: Apache-2.0
// Arrays of NumPy (.npy, versions 1 to 3): integers and floating point of 2, 4 or 8 bytes, either byte order,
// shape (height, width) or (height, width, 1), in C order. Negative integers mean no measurement; those above
// 65535 are a fault. Source: numpy.lib.format.
#pragma once

#include "devices/images/depth_header.h"

namespace fathom {

// True if the first bytes are those of NumPy.
bool isNpy(ImageBytes bytes);
// Reads the header only.
DepthHeader npyHeader(ImageBytes bytes);
// Both return the fault, or empty when all was read. `out` has as many elements as npyHeader() states, of the
// kind that it states.
std::string readNpy(ImageBytes bytes, std::span<uint16_t> out);
std::string readNpy(ImageBytes bytes, std::span<float> out);

} // namespace fathom
