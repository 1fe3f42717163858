// SPDX-License-Identifier: Apache-2.0
#include "engine/types/yuyv.h"

#include <algorithm>

namespace fathom {

namespace {

uint32_t byteOf(int value) {
    return static_cast<uint32_t>(std::clamp(value, 0, 255));
}

// BT.601: luma 16..235, chroma 16..240 about 128, of red, green, blue 0..255; in 1/65536.
uint32_t lumaOf(uint32_t rgba) {
    const int r = rgba & 255, g = rgba >> 8 & 255, b = rgba >> 16 & 255;
    return byteOf((16829 * r + 33039 * g + 6416 * b + (16 << 16) + 32768) >> 16);
}

// red, green, blue: sums of two pixels.
uint32_t chromaOf(int red, int green, int blue, int ofRed, int ofGreen, int ofBlue) {
    return byteOf((ofRed * red + ofGreen * green + ofBlue * blue + (128 << 17) + 65536) >> 17);
}

} // namespace

std::array<uint32_t, 2> rgbaOfYuyv(uint32_t word) noexcept {
    const int u = static_cast<int>(word >> 8 & 255) - 128, v = static_cast<int>(word >> 24) - 128;
    const int red = 409 * v + 128, green = -100 * u - 208 * v + 128, blue = 516 * u + 128;
    const auto pixel = [&](uint32_t y) {
        const int c = 298 * (static_cast<int>(y & 255) - 16);
        return byteOf((c + red) >> 8) | byteOf((c + green) >> 8) << 8 | byteOf((c + blue) >> 8) << 16 |
               0xff000000u;
    };
    return {pixel(word), pixel(word >> 16)};
}

void unpackYuyv(std::span<const uint32_t> words, std::span<uint32_t> rgba) noexcept {
    for (size_t i = 0; i < words.size(); ++i) {
        const auto pair = rgbaOfYuyv(words[i]);
        rgba[2 * i] = pair[0], rgba[2 * i + 1] = pair[1];
    }
}

void packYuyv(std::span<const uint32_t> rgba, std::span<uint32_t> words) noexcept {
    for (size_t i = 0; i < words.size(); ++i) {
        const uint32_t a = rgba[2 * i], b = rgba[2 * i + 1];
        const auto sum = [&](int shift) { return static_cast<int>((a >> shift & 255) + (b >> shift & 255)); };
        const int red = sum(0), green = sum(8), blue = sum(16);
        words[i] = lumaOf(a) | chromaOf(red, green, blue, -9714, -19070, 28784) << 8 | lumaOf(b) << 16 |
                   chromaOf(red, green, blue, 28784, -24103, -4681) << 24;
    }
}

} // namespace fathom
