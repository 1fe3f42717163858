// SPDX-License-Identifier: Apache-2.0
// The header of a NumPy array: a Python dictionary as text.
#pragma once

#include "devices/images/depth_header.h"

namespace fathom {

struct NpyHeader {
    uint32_t width = 0, height = 0;
    char kind = 0;      // 'u' integers without sign, 'i' with sign, 'f' floating point
    uint32_t bytes = 0; // of one value: 2, 4 or 8
    bool bigEndian = false;
    size_t values = 0; // where they begin
    std::string fault; // names the field, its value and what is allowed; empty = all above is set
};

// At most 64 KiB of header, images of at most 3840x2160.
NpyHeader parseNpyHeader(ImageBytes bytes);

} // namespace fathom
