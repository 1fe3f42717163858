// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/buffer.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"

#include <utility>

namespace fathom::gpu {

Buffer::Buffer(const Device& device, uint64_t bytes, MemoryKind kind, const char* name)
    : device_(&device)
    , bytes_((bytes + 15) / 16 * 16) {
    if (bytes_ > device.facts().maxStorageBufferBytes) {
        throw Error(std::string("buffer ") + name + " of " + std::to_string(bytes_) +
                    " bytes exceeds the device's limit of " +
                    std::to_string(device.facts().maxStorageBufferBytes));
    }
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes_;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    check(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), handle_, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = device.memoryType(kind, needs.memoryTypeBits);
    check(vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_), name);
    check(vkBindBufferMemory(device.handle(), handle_, memory_, 0), "vkBindBufferMemory");
    if (kind != MemoryKind::Device) {
        check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
    }
}

Buffer::~Buffer() {
    if (device_ != nullptr) {
        vkDestroyBuffer(device_->handle(), handle_, nullptr);
        vkFreeMemory(device_->handle(), memory_, nullptr);
    }
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
}

} // namespace fathom::gpu
