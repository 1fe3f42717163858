// SPDX-License-Identifier: Apache-2.0
// A Vulkan buffer with its own memory, permanently mapped when the CPU can access it.
#pragma once

#include "engine/gpu/device.h"

#include <memory>
#include <span>
#include <vector>

namespace fathom::gpu {

// Host memory that a device reads in place: whole pages from `memory` on.
struct HostPages {
    std::shared_ptr<const void> memory; // owned as long as the buffer exists
    uint64_t bytes;                     // bytes in use
};

// Move-only. Buffers are created at start, and during frames only for new camera memory. A
// default-constructed buffer is empty: its handle is null.
class Buffer {
public:
    Buffer() = default;
    // Throws Error when bytes exceed the device's largest storage buffer or memory runs out.
    Buffer(const Device& device, uint64_t bytes, MemoryKind kind, const char* name);
    // Imports host pages as a buffer that the device reads (VK_EXT_external_memory_host). Throws Error when
    // the device cannot import them.
    Buffer(const Device& device, const HostPages& pages, const char* name);
    ~Buffer();
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }

    VkBuffer handle() const { return handle_; }
    uint64_t bytes() const { return bytes_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

    // Whether the memory is imported host memory; it is not mapped then.
    bool imported() const { return pages_ != nullptr; }

    // The mapped memory as T; only for Upload and Readback.
    template <class T>
    std::span<T> as() const {
        return {static_cast<T*>(mapped_), bytes_ / sizeof(T)};
    }

private:
    Buffer(const Device& device,
           uint64_t bytes); // leaves the handle null, so that delegating constructors may throw
    VkMemoryRequirements create(const void* next);
    void bind(VkMemoryAllocateInfo allocate, const std::vector<uint32_t>& types, const char* name);
    void swap(Buffer& other) noexcept;

    const Device* device_ = nullptr;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    uint64_t bytes_ = 0;
    void* mapped_ = nullptr;
    std::shared_ptr<const void> pages_;
};

} // namespace fathom::gpu
