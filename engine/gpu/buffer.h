// SPDX-License-Identifier: Apache-2.0
// A buffer with its own memory, mapped for life when the CPU can see it.
#pragma once

#include "engine/gpu/device.h"

#include <memory>
#include <span>

namespace fathom::gpu {

// Memory of the host's that a device reads where it is: whole pages from `memory` on.
struct HostPages {
    std::shared_ptr<const void> memory; // kept for as long as the buffer lives
    uint64_t bytes;                     // of them that matter
};

// Move-only. Buffers are made at start, on the frame path only for memory of a camera that is new there. A
// default-constructed buffer is empty: handle null.
class Buffer {
public:
    Buffer() = default;
    // Throws Error when bytes exceed the device's largest storage buffer (a uniform buffer holds parameters
    // only) or memory runs out.
    Buffer(const Device& device, uint64_t bytes, MemoryKind kind, const char* name);
    // The host's pages as a buffer that the device reads (VK_EXT_external_memory_host). Throws Error when
    // this device cannot import them.
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

    // Whether the memory is the host's, imported; nothing is mapped then.
    bool imported() const { return pages_ != nullptr; }

    // The mapped memory as T; only for Upload and Readback.
    template <class T>
    std::span<T> as() const {
        return {static_cast<T*>(mapped_), bytes_ / sizeof(T)};
    }

private:
    Buffer(const Device& device, uint64_t bytes); // no handle yet; who delegates to it may throw
    VkMemoryRequirements create(const void* next);
    void bind(const VkMemoryAllocateInfo& allocate, const char* name);
    void swap(Buffer& other) noexcept;

    const Device* device_ = nullptr;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    uint64_t bytes_ = 0;
    void* mapped_ = nullptr;
    std::shared_ptr<const void> pages_;
};

} // namespace fathom::gpu
