// SPDX-License-Identifier: Apache-2.0
// Draws frames of the window on the CPU: images below, panels above. For devices that are the CPU
// themselves, whose rasteriser takes several times as long for thousands of small triangles.
#pragma once

#include "apps/operate/layer.h"
#include "apps/operate/panel_items.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom::operate {

// The font atlas of ImGui: coverage 0..255 of texels.
struct Coverage {
    const unsigned char* texels = nullptr;
    int width = 0, height = 0;

    // Two rows of texels, and the share of the lower one (of 256).
    struct Line {
        const unsigned char *upper = nullptr, *lower = nullptr;
        int width = 0;
        uint32_t share = 0;
        uint32_t at(float u) const {
            const float most = static_cast<float>(width - 1);
            const float x = std::clamp(u * static_cast<float>(width) - 0.5f, 0.0f, most);
            const int x0 = static_cast<int>(x), next = x0 + 1 < width ? x0 + 1 : x0;
            const auto right =
                static_cast<uint32_t>(static_cast<int>((x - static_cast<float>(x0)) * 256.0f + 0.5f));
            const uint32_t above = upper[x0] * (256 - right) + upper[next] * right;
            const uint32_t below = lower[x0] * (256 - right) + lower[next] * right;
            return (above * (256 - share) + below * share + 0x8000u) >> 16;
        }
    };
    // Bilinear, at texture coordinates 0..1 of the atlas.
    Line line(float v) const;
    uint32_t at(float u, float v) const { return line(v).at(u); }
};

// One image of the window, resampled to its place.
class PlacedLayer {
public:
    // True when its pixels or its place in a window of this size have changed. Keeps a copy of fresh pixels.
    bool update(const Layer& layer, const PixelBox& window);
    const PixelBox& box() const { return box_; } // empty: not drawn
    const uint32_t* row(int y) const {           // 0xAARRGGBB, from box().x0
        return placed_.data() + static_cast<size_t>(y - box_.y0) * static_cast<size_t>(box_.x1 - box_.x0);
    }

private:
    void resample();

    std::vector<uint32_t> source_, placed_;
    int width_ = 0, height_ = 0; // of the source
    PixelBox box_;
};

// Window thread. Needs an ImGui context.
class PanelRaster {
public:
    static constexpr int kTile = 64; // [pixels]

    void takeFonts(); // call when ImGui's font atlas has changed

    // Draws into `pixels` (0xAARRGGBB, size.width x size.height), which keep what the previous call left.
    // Only tiles whose content has changed are drawn; returns them, one box per row of tiles with changes.
    // A change of size draws all.
    std::span<const PixelBox> draw(std::span<uint32_t> pixels, int width, int height,
                                   std::span<const Layer> layers, const ImDrawData& data);
    void forget() { hashes_.clear(); }        // the next draw() draws all
    uint64_t tiles() const { return tiles_; } // drawn so far

private:
    void sortIntoTiles();
    bool drawTile(std::span<uint32_t> pixels, size_t tile);
    PixelBox boxOf(size_t tile) const;

    Coverage fonts_;
    std::array<PlacedLayer, kMaxLayers> layers_;
    std::array<uint64_t, kMaxLayers> versions_{};
    std::vector<PanelItem> items_;
    std::vector<std::vector<uint32_t>> lists_; // items of each tile
    std::vector<uint64_t> hashes_, newHashes_; // content of each tile
    std::vector<PixelBox> changed_;
    int width_ = 0, height_ = 0, across_ = 0;
    uint64_t tiles_ = 0;
};

} // namespace fathom::operate
