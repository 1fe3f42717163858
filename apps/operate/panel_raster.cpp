// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/panel_raster.h"

#include "apps/operate/panel_fill.h"

#include <algorithm>

namespace fathom::operate {

namespace {

constexpr uint64_t kEmptyTile = 0xcbf29ce484222325ull; // hash of a tile without content

// Whether all corners of the box are outside of one side of a triangle.
bool misses(const PanelItem& item, const PixelBox& box) {
    const ImVec2 corners[3] = {item.a.pos, item.b.pos, item.c.pos};
    const auto side = [&](int i, float x, float y) {
        const ImVec2 &p = corners[i], &q = corners[(i + 1) % 3];
        return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
    };
    const auto x0 = static_cast<float>(box.x0), y0 = static_cast<float>(box.y0);
    const auto x1 = static_cast<float>(box.x1), y1 = static_cast<float>(box.y1);
    const float turn = side(0, corners[2].x, corners[2].y) < 0.0f ? -1.0f : 1.0f;
    for (int i = 0; i < 3; ++i) {
        const float most = std::max(
            {turn * side(i, x0, y0), turn * side(i, x1, y0), turn * side(i, x0, y1), turn * side(i, x1, y1)});
        if (most < 0.0f) {
            return true;
        }
    }
    return false;
}

} // namespace

void PanelRaster::takeFonts() {
    unsigned char* texels = nullptr;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&texels, &fonts_.width, &fonts_.height);
    fonts_.texels = texels;
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    forget();
}

PixelBox PanelRaster::boxOf(size_t tile) const {
    const int x = static_cast<int>(tile) % across_ * kTile, y = static_cast<int>(tile) / across_ * kTile;
    return {x, y, std::min(width_, x + kTile), std::min(height_, y + kTile)};
}

// Each tile gets its items in drawing order, without those that a later one hides, and a hash of them.
void PanelRaster::sortIntoTiles() {
    for (auto& list : lists_) {
        list.clear();
    }
    newHashes_.assign(lists_.size(), kEmptyTile);
    for (size_t i = 0; i < layers_.size(); ++i) {
        for (size_t tile = 0; tile < lists_.size(); ++tile) {
            if (!overlap(layers_[i].box(), boxOf(tile)).empty()) {
                newHashes_[tile] = mixed(newHashes_[tile], versions_[i]);
            }
        }
    }
    for (size_t i = 0; i < items_.size(); ++i) {
        const PanelItem& item = items_[i];
        const uint64_t hash = item.hash();
        const bool large = item.box.x1 - item.box.x0 > kTile || item.box.y1 - item.box.y0 > kTile;
        for (int y = item.box.y0 / kTile; y <= (item.box.y1 - 1) / kTile; ++y) {
            for (int x = item.box.x0 / kTile; x <= (item.box.x1 - 1) / kTile; ++x) {
                const auto tile = static_cast<size_t>(y * across_ + x);
                if (large && !item.isRectangle && misses(item, boxOf(tile))) {
                    continue;
                }
                if (large && hides(item, boxOf(tile), fonts_)) {
                    lists_[tile].clear();
                    newHashes_[tile] = kEmptyTile;
                }
                lists_[tile].push_back(static_cast<uint32_t>(i));
                newHashes_[tile] = mixed(newHashes_[tile], hash);
            }
        }
    }
}

bool PanelRaster::drawTile(std::span<uint32_t> pixels, size_t tile) {
    if (hashes_[tile] == newHashes_[tile]) {
        return false;
    }
    const PixelBox box = boxOf(tile);
    const RasterImage image{pixels.data(), width_};
    for (int y = box.y0; y < box.y1; ++y) {
        uint32_t* row = image.row(y);
        std::fill(row + box.x0, row + box.x1, kBackground);
        for (const PlacedLayer& layer : layers_) {
            const PixelBox part = overlap(layer.box(), {box.x0, y, box.x1, y + 1});
            if (!part.empty()) {
                std::copy_n(layer.row(y) + (part.x0 - layer.box().x0), part.x1 - part.x0, row + part.x0);
            }
        }
    }
    for (const uint32_t i : lists_[tile]) {
        fillItem(image, items_[i], box, fonts_);
    }
    ++tiles_;
    return true;
}

std::span<const PixelBox> PanelRaster::draw(std::span<uint32_t> pixels, int width, int height,
                                            std::span<const Layer> layers, const ImDrawData& data) {
    if (width != width_ || height != height_) {
        forget();
    }
    width_ = width;
    height_ = height;
    across_ = (width + kTile - 1) / kTile;
    const PixelBox window{0, 0, width, height};
    for (size_t i = 0; i < std::min(layers.size(), kMaxLayers); ++i) {
        versions_[i] += layers_[i].update(layers[i], window) ? 1 : 0;
    }
    lists_.resize(static_cast<size_t>(across_) * static_cast<size_t>((height + kTile - 1) / kTile));
    hashes_.resize(lists_.size());
    listItems(data, window, items_);
    sortIntoTiles();
    changed_.clear();
    for (size_t first = 0; first < lists_.size(); first += static_cast<size_t>(across_)) {
        PixelBox row{width, 0, 0, 0};
        for (size_t tile = first; tile < first + static_cast<size_t>(across_); ++tile) {
            if (drawTile(pixels, tile)) {
                const PixelBox box = boxOf(tile);
                row = {std::min(row.x0, box.x0), box.y0, box.x1, box.y1};
            }
        }
        if (!row.empty()) {
            changed_.push_back(row);
        }
    }
    std::swap(hashes_, newHashes_);
    return changed_;
}

} // namespace fathom::operate
