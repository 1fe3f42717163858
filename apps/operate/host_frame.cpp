// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/host_frame.h"

namespace fathom::operate {

void HostFrame::draw(VkExtent2D size, std::span<const Layer> layers, const ImDrawData& data) {
    if (size.width != size_.width || size.height != size_.height) {
        pixels_ = gpu::Buffer(device_, 4ull * size.width * size.height, gpu::MemoryKind::Upload, "window");
        size_ = size;
        copies_.clear();
        raster_.forget();
    }
    for (const PixelBox& box : raster_.draw(pixels_.as<uint32_t>(), static_cast<int>(size.width),
                                            static_cast<int>(size.height), layers, data)) {
        const auto x = static_cast<uint32_t>(box.x0), y = static_cast<uint32_t>(box.y0);
        VkBufferImageCopy copy{};
        copy.bufferOffset = 4ull * (VkDeviceSize{y} * size.width + x);
        copy.bufferRowLength = size.width;
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageOffset = {box.x0, box.y0, 0};
        copy.imageExtent = {static_cast<uint32_t>(box.x1) - x, static_cast<uint32_t>(box.y1) - y, 1};
        copies_.push_back(copy);
    }
}

void HostFrame::record(VkCommandBuffer commands, VkImage target) {
    if (!copies_.empty()) {
        vkCmdCopyBufferToImage(commands, pixels_.handle(), target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                               static_cast<uint32_t>(copies_.size()), copies_.data());
    }
    copies_.clear();
}

} // namespace fathom::operate
