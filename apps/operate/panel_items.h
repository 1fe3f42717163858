// SPDX-License-Identifier: Apache-2.0
// What ImGui draws in a frame, as rectangles and triangles with the pixels that they can touch.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <imgui.h>
#include <vector>

namespace fathom::operate {

// Pixels [x0, x1) x [y0, y1).
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
    bool operator==(const PixelBox&) const = default;
};
// The first pixel whose centre is at or after this coordinate.
inline int pixelFrom(float at) {
    return static_cast<int>(std::ceil(std::clamp(at, -1e6f, 1e6f) - 0.5f));
}
PixelBox overlap(const PixelBox& a, const PixelBox& b);

// A rectangle of one colour (`isRectangle`: a = top left, b = bottom right), or a triangle.
struct PanelItem {
    ImDrawVert a{}, b{}, c{};
    PixelBox box; // bounds, inside the clip rectangle and the window
    bool isRectangle = false;
    uint64_t hash() const; // of everything that changes its pixels
};

// In drawing order; without those outside of `window`. Callbacks of draw lists are ignored.
void listItems(const ImDrawData& data, const PixelBox& window, std::vector<PanelItem>& items);

// Mixes a word into a hash.
inline uint64_t mixed(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    return hash ^ hash >> 29;
}

} // namespace fathom::operate
