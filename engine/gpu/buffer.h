// SPDX-License-Identifier: Apache-2.0
// A buffer with its own memory, mapped for life when the CPU can see it.
#pragma once

#include "engine/gpu/device.h"

#include <span>

namespace fathom::gpu {

// Move-only. Buffers are made at start, never on the frame path. A default-constructed buffer is empty:
// handle null.
class Buffer {
public:
    Buffer() = default;
    // Throws Error when bytes exceed the device's largest storage buffer (a uniform buffer holds parameters
    // only) or memory runs out.
    Buffer(const Device& device, uint64_t bytes, MemoryKind kind, const char* name);
    ~Buffer();
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }

    VkBuffer handle() const { return handle_; }
    uint64_t bytes() const { return bytes_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

    // The mapped memory as T; only for Upload and Readback.
    template <class T>
    std::span<T> as() const {
        return {static_cast<T*>(mapped_), bytes_ / sizeof(T)};
    }

private:
    void swap(Buffer& other) noexcept;

    const Device* device_ = nullptr;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    uint64_t bytes_ = 0;
    void* mapped_ = nullptr;
};

} // namespace fathom::gpu
