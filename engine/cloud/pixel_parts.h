// SPDX-License-Identifier: Apache-2.0
// Connected parts of selected pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fathom::cloud {

// A pixel that may belong to a part.
struct PartPixel {
    uint32_t u, v;
    uint32_t slot; // the caller's: where its point is
    float z;       // along the optical axis [m]
};

// pixels: in row-major order, each at most once. 8-connected pixels are in one part if their depths differ by
// at most edge (relative; 0 = any). Returns for each pixel the index of the first pixel of its part.
std::vector<uint32_t> connectedParts(std::span<const PartPixel> pixels, double edge);

// Number of pixels of each part, at the index of its first pixel; 0 elsewhere.
std::vector<uint32_t> partSizes(std::span<const uint32_t> parts);

} // namespace fathom::cloud
