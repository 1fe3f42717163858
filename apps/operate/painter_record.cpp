// SPDX-License-Identifier: Apache-2.0
// Records the commands of a window frame, and reads it back for screenshots.
#include "apps/operate/painter.h"
#include "apps/output/image.h"
#include "engine/gpu/result.h"

#include <algorithm>

namespace fathom::operate {

using gpu::check;

namespace {

constexpr VkClearColorValue kBackgroundColour{{0.035f, 0.047f, 0.063f, 1.0f}};
constexpr auto kSource = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
constexpr auto kDestination = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
constexpr VkImageSubresourceLayers kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

VkOffset3D corner(int x, int y, int z = 0) {
    return {x, y, z};
}

VkBufferImageCopy wholeImage(VkExtent2D size) {
    VkBufferImageCopy copy{};
    copy.imageSubresource = kWhole;
    copy.imageExtent = {size.width, size.height, 1};
    return copy;
}

} // namespace

void Painter::recordLayer(size_t i, const Layer& layer) {
    Staged& staged = staged_[i];
    if (!staged.image) {
        return;
    }
    const VkExtent2D size = staged.image.size();
    if (staged.fresh) {
        changeLayout(commands_, staged.image.handle(), VK_IMAGE_LAYOUT_UNDEFINED, kDestination);
        const VkBufferImageCopy copy = wholeImage(size);
        vkCmdCopyBufferToImage(commands_, staged.staging.handle(), staged.image.handle(), kDestination, 1,
                               &copy);
        changeLayout(commands_, staged.image.handle(), kDestination, kSource);
    }
    const int right = layer.where.x + layer.where.width, bottom = layer.where.y + layer.where.height;
    if (layer.where.width < 2 || layer.where.height < 2 || layer.where.x < 0 || layer.where.y < 0 ||
        right > static_cast<int>(target_.size().width) || bottom > static_cast<int>(target_.size().height)) {
        return; // the window has just shrunk: skip this image for one frame
    }
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = kWhole;
    blit.srcOffsets[1] = corner(static_cast<int>(size.width), static_cast<int>(size.height), 1);
    blit.dstOffsets[0] = corner(layer.where.x, layer.where.y);
    blit.dstOffsets[1] = corner(right, bottom, 1);
    vkCmdBlitImage(commands_, staged.image.handle(), kSource, target_.handle(), kDestination, 1, &blit,
                   VK_FILTER_LINEAR);
    changeLayout(commands_, target_.handle(), kDestination, kDestination); // later layers are on top
}

void Painter::recordOnDevice(std::span<const Layer> layers, ImDrawData* data) {
    changeLayout(commands_, target_.handle(), VK_IMAGE_LAYOUT_UNDEFINED, kDestination);
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands_, target_.handle(), kDestination, &kBackgroundColour, 1, &range);
    changeLayout(commands_, target_.handle(), kDestination, kDestination);
    for (size_t i = 0; i < std::min(layers.size(), kMaxLayers); ++i) {
        recordLayer(i, layers[i]);
    }
    changeLayout(commands_, target_.handle(), kDestination, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    panels_->record(commands_, framebuffer_, target_.size(), data);
    changeLayout(commands_, target_.handle(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kSource);
}

void Painter::recordFromHost() {
    changeLayout(commands_, target_.handle(), latest_.filled ? kSource : VK_IMAGE_LAYOUT_UNDEFINED,
                 kDestination);
    host_->record(commands_, target_.handle());
    changeLayout(commands_, target_.handle(), kDestination, kSource);
    latest_.filled = true;
}

void Painter::record(std::span<const Layer> layers, ImDrawData* data, VkImage shown) {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
    if (host_) {
        recordFromHost();
    } else {
        recordOnDevice(layers, data);
    }
    if (shown != VK_NULL_HANDLE) {
        recordToSurface(shown);
    }
    check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
}

void Painter::recordToSurface(VkImage shown) {
    changeLayout(commands_, shown, VK_IMAGE_LAYOUT_UNDEFINED, kDestination);
    const VkExtent2D size = target_.size();
    if (swapchain_->format() == kDrawn) { // a copy is faster than a blit on a software device
        VkImageCopy copy{};
        copy.srcSubresource = copy.dstSubresource = kWhole;
        copy.extent = {size.width, size.height, 1};
        vkCmdCopyImage(commands_, target_.handle(), kSource, shown, kDestination, 1, &copy);
    } else {
        VkImageBlit blit{};
        blit.srcSubresource = blit.dstSubresource = kWhole;
        blit.srcOffsets[1] = blit.dstOffsets[1] =
            corner(static_cast<int>(size.width), static_cast<int>(size.height), 1);
        vkCmdBlitImage(commands_, target_.handle(), kSource, shown, kDestination, 1, &blit,
                       VK_FILTER_NEAREST);
    }
    changeLayout(commands_, shown, kDestination, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

std::unique_ptr<Image> Painter::frameImage(int below) {
    if (!current_) {
        return nullptr;
    }
    const VkExtent2D size = target_.size();
    const gpu::Buffer landing(device_, 4ull * size.width * size.height, gpu::MemoryKind::Readback,
                              "screenshot");
    once([&](VkCommandBuffer commands) {
        const VkBufferImageCopy copy = wholeImage(size);
        changeLayout(commands, target_.handle(), kSource, kSource);
        vkCmdCopyImageToBuffer(commands, target_.handle(), kSource, landing.handle(), 1, &copy);
        VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                               VK_ACCESS_HOST_READ_BIT};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                             &toHost, 0, nullptr, 0, nullptr);
    });
    auto image = std::make_unique<Image>(static_cast<int>(size.width), static_cast<int>(size.height) + below,
                                         Colour{0.0, 0.0, 0.0});
    image->beginPixels();
    const auto pixels = landing.as<uint32_t>();
    for (uint32_t v = 0; v < size.height; ++v) {
        uint32_t* row = image->row(static_cast<int>(v));
        for (uint32_t u = 0; u < size.width; ++u) {
            row[u] = 0xff000000u | pixels[v * size.width + u]; // both are 0xAARRGGBB
        }
    }
    image->endPixels();
    return image;
}

} // namespace fathom::operate
