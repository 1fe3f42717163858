// SPDX-License-Identifier: Apache-2.0
// Composes a window frame on the device: CPU images below, ImGui above, then copies it to the surface if
// there is one. One frame in flight.
#pragma once

#include "apps/operate/frame_texture.h"
#include "apps/operate/panel_backend.h"
#include "apps/operate/swapchain.h"

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace fathom {
class Image; // apps/replay/image.h
}

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

// Window thread. Needs an ImGui context during its lifetime. Every call throws DeviceFailed when the device
// is lost; then destroy the painter before the device.
class Painter {
public:
    // swapchain null: offscreen. Uploads the font atlas of ImGui.
    Painter(const gpu::Instance& instance, gpu::Device& device, Swapchain* swapchain);
    ~Painter();
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    void uploadFonts(); // call when the atlas has changed

    // Draws a frame of this size; later layers are on top. Returns false when the frame is skipped because
    // the previous one is not done or the surface has no image yet. `busy` returns whether compute passes run
    // on a shared queue: the frame waits up to kCourtesy for them and is skipped if they still run.
    bool draw(VkExtent2D size, std::span<const Layer> layers, ImDrawData* data,
              const std::function<bool()>& busy);
    // Waits for the last frame and copies it. below: rows of pixels to add under it. Null: nothing was drawn
    // yet.
    std::unique_ptr<Image> picture(int below);

    uint64_t drawn() const { return drawn_; }
    uint64_t yielded() const { return yielded_; } // frames skipped for compute passes
    static constexpr double kCourtesy = 0.012;    // [s]
    static constexpr size_t kMaxLayers = 2;

private:
    struct Staged {
        FrameTexture image;
        gpu::Buffer staging;
        bool fresh = false; // staged for this frame
    };
    struct Unmade {}; // creates none of the painter's own device objects
    Painter(const gpu::Instance& instance, gpu::Device& device, Swapchain* swapchain, Unmade);
    void resize(VkExtent2D size);
    bool finished(uint64_t patience); // [ns]
    bool yields(const std::function<bool()>& busy);
    void stage(std::span<const Layer> layers);
    void record(std::span<const Layer> layers, ImDrawData* data, VkImage shown);
    void recordLayer(size_t i, const Layer& layer);
    void recordToSurface(VkImage shown);
    void submit(bool onSurface);
    void once(const std::function<void(VkCommandBuffer)>& body);

    gpu::Device& device_;
    Swapchain* swapchain_;
    PanelBackend panels_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence done_ = VK_NULL_HANDLE;
    VkSemaphore ready_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    FrameTexture target_;
    std::array<Staged, kMaxLayers> staged_;
    bool flying_ = false; // a submission may still be running
    uint64_t drawn_ = 0, yielded_ = 0;
};

} // namespace fathom::operate
