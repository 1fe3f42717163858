// SPDX-License-Identifier: Apache-2.0
// A timeline semaphore: a counter that submissions raise and the CPU can wait for.
#pragma once

#include "engine/gpu/device.h"

namespace fathom::gpu {

class Timeline {
public:
    explicit Timeline(const Device& device);
    ~Timeline();
    Timeline(const Timeline&) = delete;
    Timeline& operator=(const Timeline&) = delete;

    VkSemaphore handle() const { return handle_; }
    uint64_t value() const; // reached so far
    // Throws DeviceLost. Asks in a loop for kAsk first where the device is not this CPU: a kernel's wake-up
    // takes as long as half a frame's passes do there.
    void wait(uint64_t value) const;

    static constexpr double kAsk = 500e-6; // [s]

private:
    bool comesSoon(uint64_t value) const;

    const Device& device_;
    VkSemaphore handle_ = VK_NULL_HANDLE;
};

} // namespace fathom::gpu
