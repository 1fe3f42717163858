// SPDX-License-Identifier: Apache-2.0
// An image below the panels of the window, and where it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fathom::operate {

struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0; // [pixels] in the window
};

// A CPU image, stretched to a rectangle. Empty pixels: same image as before.
struct Layer {
    std::span<const uint32_t> pixels; // 0xAABBGGRR, width x height
    uint32_t width = 0, height = 0;
    PixelRect where; // not drawn when empty
};

constexpr size_t kMaxLayers = 2;

// Below everything, 0xAARRGGBB.
constexpr uint32_t kBackground = 0xff090c10u;

} // namespace fathom::operate
