// SPDX-License-Identifier: Apache-2.0
// Composes a window frame: CPU images below, ImGui above, then copies it to the surface if there is one. The
// device draws it, or the CPU if the device is one. One frame in flight.
#pragma once

#include "apps/operate/frame_texture.h"
#include "apps/operate/host_frame.h"
#include "apps/operate/panel_backend.h"
#include "apps/operate/swapchain.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>

namespace fathom {
class Image; // apps/output/image.h
}

namespace fathom::operate {

// Window thread. Needs an ImGui context during its lifetime. Every call throws DeviceFailed when the device
// is lost or does not finish a frame; then destroy the painter before the device.
class Painter {
public:
    enum class By { Device, Cpu };
    static By drawerFor(const gpu::Device& device) {
        return device.facts().kind == DeviceKind::Cpu ? By::Cpu : By::Device;
    }
    // swapchain null: offscreen. Uploads the font atlas of ImGui.
    Painter(const gpu::Instance& instance, gpu::Device& device, Swapchain* swapchain, By drawer);
    ~Painter();
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    void uploadFonts(); // call when the atlas has changed

    // Draws a frame of this size; later layers are on top. Returns false when the frame is skipped because
    // the previous one is not done or the surface has no image yet. `busy` returns whether compute passes run
    // on a shared queue: the device's drawing waits up to kMaxYield for them and is skipped if they still
    // run. What the CPU draws needs only a copy and never waits; a frame without changes is not drawn or
    // shown again, but counts as drawn.
    bool draw(VkExtent2D size, std::span<const Layer> layers, ImDrawData* data,
              const std::function<bool()>& busy);
    // Waits for the last frame, so that the next draw() does not skip for it.
    void awaitFrame();
    // Waits for the last frame and copies it. below: rows of pixels to add under it. Null: the last draw()
    // drew nothing.
    std::unique_ptr<Image> frameImage(int below);

    void redraw() { latest_.shown = false; } // the surface has lost its content

    uint64_t drawn() const { return counts_.drawn; }
    uint64_t tiles() const { return host_ ? host_->tiles() : 0; } // drawn by the CPU so far (PanelRaster)
    uint64_t yielded() const { return counts_.yielded; }          // frames skipped for compute passes
    static constexpr double kMaxYield = 0.012;                    // [s] wait for compute passes

private:
    struct Staged {
        FrameTexture image;
        gpu::Buffer staging;
        bool fresh = false; // staged for this frame
    };
    struct EmptyTag {}; // creates none of the painter's own device objects
    Painter(const gpu::Instance& instance, gpu::Device& device, Swapchain* swapchain, By drawer, EmptyTag);
    void resize(VkExtent2D size);
    bool finished(uint64_t patience); // [ns]
    bool drawNow(VkExtent2D size, std::span<const Layer> layers, ImDrawData* data);
    bool yields(const std::function<bool()>& busy);
    void stage(std::span<const Layer> layers);
    void record(std::span<const Layer> layers, ImDrawData* data, VkImage shown);
    void recordOnDevice(std::span<const Layer> layers, ImDrawData* data);
    void recordFromHost();
    void recordLayer(size_t i, const Layer& layer);
    void recordToSurface(VkImage shown);
    void submit(bool onSurface);
    void once(const std::function<void(VkCommandBuffer)>& body);

    gpu::Device& device_;
    Swapchain* swapchain_;
    std::optional<HostFrame> host_;      // where the CPU draws
    std::optional<PanelBackend> panels_; // where the device draws
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence done_ = VK_NULL_HANDLE;
    VkSemaphore ready_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    FrameTexture target_;
    std::array<Staged, kMaxLayers> staged_;
    bool inFlight_ = false; // a submission may still be running
    bool current_ = false;  // target_ has the frame of the last draw()
    struct {
        bool filled = false; // target_ has a frame of the CPU
        bool shown = false;  // the surface shows target_
        uint32_t remade = 0; // of the swapchain, when it was shown
    } latest_;
    struct {
        uint64_t drawn = 0, yielded = 0;
    } counts_;
};

} // namespace fathom::operate
