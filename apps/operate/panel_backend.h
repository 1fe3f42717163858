// SPDX-License-Identifier: Apache-2.0
// ImGui's Vulkan backend: the render pass and descriptors of the window's panels.
#pragma once

#include "engine/gpu/device.h"

#include <functional>

struct ImDrawData;

namespace fathom::operate {

// Window thread. Needs an ImGui context during its lifetime. No submission that uses it may be in flight when
// it is restarted or destroyed. Every call throws DeviceLost when the device is lost.
class PanelBackend {
public:
    PanelBackend(const gpu::Instance& instance, gpu::Device& device);
    ~PanelBackend();
    PanelBackend(const PanelBackend&) = delete;
    PanelBackend& operator=(const PanelBackend&) = delete;

    // Starts the backend with ImGui's present font atlas. once: records and runs commands, and waits.
    using Once = std::function<void(const std::function<void(VkCommandBuffer)>&)>;
    void restart(const Once& once);

    VkRenderPass pass() const { return pass_; } // loads its one attachment, of format kDrawn
    // Draws the panels in the pass over what the framebuffer contains.
    void record(VkCommandBuffer commands, VkFramebuffer framebuffer, VkExtent2D size, ImDrawData* data) const;

private:
    explicit PanelBackend(gpu::Device& device); // creates no device objects
    void start();
    void stop();
    static void nameTexture(ImDrawData& data);

    VkInstance instance_ = VK_NULL_HANDLE;
    gpu::Device& device_;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
};

} // namespace fathom::operate
