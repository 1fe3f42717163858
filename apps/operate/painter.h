// SPDX-License-Identifier: Apache-2.0
// Puts a window frame together on the device: pictures from the CPU below, ImGui's triangles above, then to
// the surface or, without one, nowhere. One frame in flight.
#pragma once

#include "apps/operate/frame_texture.h"
#include "apps/operate/swapchain.h"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

struct ImDrawData;

namespace fathom::operate {

struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0; // [pixels] of the window
};

// A picture of the CPU and where it goes, stretched. pixels empty: as before.
struct Layer {
    std::span<const uint32_t> pixels; // 0xAABBGGRR, width x height
    uint32_t width = 0, height = 0;
    PixelRect where; // nothing when empty
};

// Thread: the window's. Needs an ImGui context while it lives. Everything throws DeviceFailed once the device
// does not work any more; then it is to be destroyed, before the device.
class Painter {
public:
    // swapchain null: offscreen. Letters that are in ImGui's atlas are uploaded.
    Painter(const gpu::Instance& instance, gpu::Device& device, Swapchain* swapchain);
    ~Painter();
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    void uploadFonts(); // after the atlas has changed; nothing may be in flight

    // Draws a frame of this size; later layers lie above. False when it was skipped: the frame before is not
    // done, or the surface has no image yet. `busy` asks whether passes are on a queue that is shared: the
    // frame then waits for up to kCourtesy and is skipped when they are still there.
    bool draw(VkExtent2D size, std::span<const Layer> layers, ImDrawData* data,
              const std::function<bool()>& busy);
    // The last frame that was drawn. Waits for it.
    void screenshot(const std::filesystem::path& file);

    uint64_t drawn() const { return drawn_; }
    uint64_t yielded() const { return yielded_; } // frames left out for the passes
    static constexpr double kCourtesy = 0.012;    // [s]
    static constexpr size_t kMostLayers = 2;

private:
    struct Staged {
        FrameTexture image;
        gpu::Buffer staging;
    };
    Painter(gpu::Device& device, Swapchain* swapchain); // without anything on the device
    void resize(VkExtent2D size);
    bool finished(uint64_t patience); // [ns]
    bool yields(const std::function<bool()>& busy);
    void stage(std::span<const Layer> layers);
    void record(std::span<const Layer> layers, ImDrawData* data, VkImage shown);
    void recordLayer(size_t i, const Layer& layer);
    void recordToSurface(VkImage shown);
    void submit(bool onSurface);
    void startPanels(); // of ImGui
    void stopPanels();
    void once(const std::function<void(VkCommandBuffer)>& body);

    VkInstance instance_ = VK_NULL_HANDLE;
    gpu::Device& device_;
    Swapchain* swapchain_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkFence done_ = VK_NULL_HANDLE;
    VkSemaphore ready_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    FrameTexture target_;
    std::array<Staged, kMostLayers> staged_;
    std::array<bool, kMostLayers> fresh_{};
    bool flying_ = false; // a submission whose end has not been seen
    uint64_t drawn_ = 0, yielded_ = 0;
};

} // namespace fathom::operate
