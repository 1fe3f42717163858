// SPDX-License-Identifier: Apache-2.0
// A window frame drawn by the CPU, and the copy of its changed parts to the device's image.
#pragma once

#include "apps/operate/panel_raster.h"
#include "engine/gpu/buffer.h"

#include <vector>

namespace fathom::operate {

// Window thread. Needs an ImGui context. draw() must not be called while a submission copies.
class HostFrame {
public:
    explicit HostFrame(const gpu::Device& device)
        : device_(device) {}

    void takeFonts() { raster_.takeFonts(); } // call when ImGui's font atlas has changed
    void draw(VkExtent2D size, std::span<const Layer> layers, const ImDrawData& data);
    bool changed() const { return !copies_.empty(); }      // since the last record()
    void record(VkCommandBuffer commands, VkImage target); // target: of draw()'s size, TRANSFER_DST_OPTIMAL
    uint64_t tiles() const { return raster_.tiles(); }

private:
    const gpu::Device& device_;
    PanelRaster raster_;
    gpu::Buffer pixels_;
    VkExtent2D size_{};
    std::vector<VkBufferImageCopy> copies_;
};

} // namespace fathom::operate
