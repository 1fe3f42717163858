// SPDX-License-Identifier: Apache-2.0
// An image on the device with its own memory: the render target of the window, and images uploaded from the
// CPU.
#pragma once

#include "engine/gpu/buffer.h"

namespace fathom::operate {

// sRGB-encoded values without conversion: kImage from the CPU, kDrawn for the render target, in the byte
// order of most displays.
constexpr VkFormat kImage = VK_FORMAT_R8G8B8A8_UNORM, kDrawn = VK_FORMAT_B8G8R8A8_UNORM;

// One colour image. Move-only. The recorder of commands tracks its layout.
class FrameTexture {
public:
    FrameTexture() = default;
    FrameTexture(const gpu::Device& device, VkFormat format, VkExtent2D size, VkImageUsageFlags usage);
    ~FrameTexture();
    FrameTexture(FrameTexture&& other) noexcept { swap(other); }
    FrameTexture& operator=(FrameTexture&& other) noexcept {
        swap(other);
        return *this;
    }

    VkImage handle() const { return image_; }
    VkImageView view() const { return view_; }
    VkExtent2D size() const { return size_; }
    explicit operator bool() const { return image_ != VK_NULL_HANDLE; }

private:
    void swap(FrameTexture& other) noexcept;

    const gpu::Device* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkExtent2D size_{};
};

// Changes the layout of a whole image; all earlier writes are visible to all later commands.
void changeLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);

} // namespace fathom::operate
