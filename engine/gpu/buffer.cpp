// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/buffer.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace fathom::gpu {

Buffer::Buffer(const Device& device, uint64_t bytes)
    : device_(&device)
    , bytes_((bytes + 15) / 16 * 16) {}

Buffer::Buffer(const Device& device, uint64_t bytes, MemoryKind kind, const char* name)
    : Buffer(device, bytes) {
    if (bytes_ > device.facts().maxStorageBufferBytes) {
        throw Error(std::string("buffer ") + name + " of " + std::to_string(bytes_) +
                    " bytes exceeds the device's limit of " +
                    std::to_string(device.facts().maxStorageBufferBytes));
    }
    const VkMemoryRequirements needs = create(nullptr);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    bind(allocate, device.memoryTypes(kind, needs.memoryTypeBits), name);
    if (kind != MemoryKind::Device) {
        check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
    }
}

Buffer::Buffer(const Device& device, const HostPages& pages, const char* name)
    : Buffer(device, pages.bytes) {
    pages_ = pages.memory;
    VkExternalMemoryBufferCreateInfo external{VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO};
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
    const VkMemoryRequirements needs = create(&external);
    const uint64_t page = std::max<uint64_t>(1, device.facts().hostPointerAlignment);
    const uint32_t types = needs.memoryTypeBits & device.hostPointerTypes(pages_.get());
    VkImportMemoryHostPointerInfoEXT import{VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT};
    import.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
    import.pHostPointer = const_cast<void*>(pages_.get()); // only read: no pass writes to uploads
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &import};
    allocate.allocationSize = (bytes_ + page - 1) / page * page;
    const bool whole = reinterpret_cast<uintptr_t>(pages_.get()) % page == 0;
    if (types == 0 || !whole || needs.size > allocate.allocationSize) {
        throw Error(std::string(name) + ": " + device.facts().name + " cannot read the host's memory there");
    }
    bind(allocate, {static_cast<uint32_t>(std::countr_zero(types))}, name);
}

VkMemoryRequirements Buffer::create(const void* next) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, next};
    info.size = bytes_;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    check(vkCreateBuffer(device_->handle(), &info, nullptr, &handle_), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_->handle(), handle_, &needs);
    return needs;
}

// In the first of the types that has room.
void Buffer::bind(VkMemoryAllocateInfo allocate, const std::vector<uint32_t>& types, const char* name) {
    VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (size_t i = 0; i < types.size() && result == VK_ERROR_OUT_OF_DEVICE_MEMORY; ++i) {
        allocate.memoryTypeIndex = types[i];
        result = vkAllocateMemory(device_->handle(), &allocate, nullptr, &memory_);
    }
    memory_ = result == VK_SUCCESS ? memory_ : VK_NULL_HANDLE;
    const std::string call =
        "buffer " + std::string(name) + " of " + std::to_string(bytes_) + " bytes: vkAllocateMemory";
    check(result, call.c_str());
    check(vkBindBufferMemory(device_->handle(), handle_, memory_, 0), "vkBindBufferMemory");
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
    std::swap(pages_, other.pages_);
}

} // namespace fathom::gpu
