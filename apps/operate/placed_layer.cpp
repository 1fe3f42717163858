// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/panel_raster.h"

#include <algorithm>
#include <cstring>

namespace fathom::operate {

namespace {

// Where a pixel of the result lies between two of the source: index of the first, share of the second (of
// 256).
struct Between {
    int first = 0;
    uint32_t share = 0;
};

std::vector<Between> stepsOf(int from, int to) {
    std::vector<Between> steps(static_cast<size_t>(to));
    for (int i = 0; i < to; ++i) {
        const double at = std::clamp((i + 0.5) * from / to - 0.5, 0.0, from - 1.0);
        const int first = std::min(static_cast<int>(at), std::max(0, from - 2));
        steps[static_cast<size_t>(i)] = {first, static_cast<uint32_t>((at - first) * 256.0 + 0.5)};
    }
    return steps;
}

// Between the channels of two rows; share of 256.
void blendRows(const uint32_t* upper, const uint32_t* lower, uint32_t share, std::vector<uint16_t>& line) {
    const auto* a = reinterpret_cast<const uint8_t*>(upper);
    const auto* b = reinterpret_cast<const uint8_t*>(lower);
    const auto second = static_cast<uint16_t>(share), first = static_cast<uint16_t>(256 - share);
    for (size_t i = 0; i < line.size(); ++i) {
        const auto sum = static_cast<uint16_t>(a[i] * first + b[i] * second + 0x80); // fits: fast
        line[i] = static_cast<uint16_t>(sum >> 8);
    }
}

// Between two pixels of four channels in 16 bits each.
uint32_t blendPixels(const uint16_t* a, const uint16_t* b, uint64_t share) {
    uint64_t first = 0, second = 0;
    std::memcpy(&first, a, sizeof first);
    std::memcpy(&second, b, sizeof second);
    uint64_t all = (first * (256 - share) + second * share + 0x0080008000800080ull) >> 8;
    all &= 0x00ff00ff00ff00ffull;
    all = (all | all >> 8) & 0x0000ffff0000ffffull;
    return static_cast<uint32_t>(all | all >> 16);
}

uint32_t displayed(uint32_t p) { // 0xAABBGGRR to 0xAARRGGBB
    return 0xff000000u | (p & 0xffu) << 16 | (p & 0xff00u) | (p >> 16 & 0xffu);
}

} // namespace

bool PlacedLayer::update(const Layer& layer, const PixelBox& window) {
    const PixelBox wanted{layer.where.x, layer.where.y, layer.where.x + layer.where.width,
                          layer.where.y + layer.where.height};
    // The window may just have shrunk: then the image is not drawn for one frame.
    const bool fits = overlap(wanted, window) == wanted && layer.where.width > 1 && layer.where.height > 1;
    const bool fresh = !layer.pixels.empty();
    if (fresh) {
        width_ = static_cast<int>(layer.width);
        height_ = static_cast<int>(layer.height);
        source_.resize(layer.pixels.size());
        std::transform(layer.pixels.begin(), layer.pixels.end(), source_.begin(), displayed);
    }
    const PixelBox box = fits && width_ > 0 && height_ > 0 ? wanted : PixelBox();
    if (!fresh && box == box_) {
        return false;
    }
    box_ = box;
    if (!box_.empty()) {
        resample();
    }
    return true;
}

void PlacedLayer::resample() {
    const int width = box_.x1 - box_.x0, height = box_.y1 - box_.y0;
    if (width == width_ && height == height_) {
        placed_ = source_;
        return;
    }
    placed_.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
    const std::vector<Between> across = stepsOf(width_, width), down = stepsOf(height_, height);
    std::vector<uint16_t> line(4 * static_cast<size_t>(width_));
    const size_t next = width_ > 1 ? 4 : 0;
    for (size_t y = 0; y < down.size(); ++y) {
        const uint32_t* upper =
            source_.data() + static_cast<size_t>(down[y].first) * static_cast<size_t>(width_);
        blendRows(upper, upper + (height_ > 1 ? width_ : 0), down[y].share, line);
        uint32_t* out = placed_.data() + y * across.size();
        for (size_t x = 0; x < across.size(); ++x) {
            const uint16_t* pixel = line.data() + 4 * static_cast<size_t>(across[x].first);
            out[x] = blendPixels(pixel, pixel + next, across[x].share);
        }
    }
}

} // namespace fathom::operate
