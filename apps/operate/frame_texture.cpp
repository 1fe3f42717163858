// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/frame_texture.h"

#include "engine/gpu/result.h"

#include <utility>

namespace fathom::operate {

using gpu::check;

namespace {

VkImageCreateInfo imageInfo(VkFormat format, VkExtent2D size, VkImageUsageFlags usage) {
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
            .imageType = VK_IMAGE_TYPE_2D,
            .format = format,
            .extent = {size.width, size.height, 1},
            .mipLevels = 1,
            .arrayLayers = 1,
            .samples = VK_SAMPLE_COUNT_1_BIT,
            .usage = usage};
}

} // namespace

FrameTexture::FrameTexture(const gpu::Device& device, VkFormat format, VkExtent2D size,
                           VkImageUsageFlags usage)
    : FrameTexture() { // delegates, so that the destructor runs when a later step throws
    device_ = &device;
    size_ = size;
    const VkImageCreateInfo info = imageInfo(format, size, usage);
    check(vkCreateImage(device.handle(), &info, nullptr, &image_), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device.handle(), image_, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = device.memoryTypes(gpu::MemoryKind::Device, needs.memoryTypeBits).front();
    check(vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_), "vkAllocateMemory of an image");
    check(vkBindImageMemory(device.handle(), image_, memory_, 0), "vkBindImageMemory");
    if ((usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) != 0) {
        const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                         .image = image_,
                                         .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                         .format = format,
                                         .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        check(vkCreateImageView(device.handle(), &view, nullptr, &view_), "vkCreateImageView");
    }
}

FrameTexture::~FrameTexture() {
    if (device_ != nullptr) {
        vkDestroyImageView(device_->handle(), view_, nullptr);
        vkDestroyImage(device_->handle(), image_, nullptr);
        vkFreeMemory(device_->handle(), memory_, nullptr);
    }
}

void FrameTexture::swap(FrameTexture& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(memory_, other.memory_);
    std::swap(view_, other.view_);
    std::swap(size_, other.size_);
}

void changeLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                       .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                       .dstAccessMask =
                                           VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                       .oldLayout = from,
                                       .newLayout = to,
                                       .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .image = image,
                                       .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                         0, nullptr, 0, nullptr, 1, &barrier);
}

} // namespace fathom::operate
