// SPDX-License-Identifier: Apache-2.0
// The channels of an OpenEXR image, and which of them is depth. Names are "LAYER.CHANNEL" or "CHANNEL".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fathom {

struct ExrChannel {
    std::string name;
    uint32_t kind = 0; // 0 uint32, 1 half, 2 float

    size_t bytes() const { return kind == 1 ? 2 : 4; } // per pixel
};

// Indices of depth, and of the G and B of its layer if it is an R: they are equal to it or 0, or show
// colours.
struct ExrDepth {
    size_t depth = 0;
    std::vector<size_t> equal;
};

// In this order: Z or depth; a channel of a layer that is called depth, such as ViewLayer.Depth.Z; the Z of a
// layer without X and Y; the only channel; Y; R. Throws Error if there is none, or several of the same rank.
ExrDepth chooseExrDepth(const std::vector<ExrChannel>& channels);

} // namespace fathom
