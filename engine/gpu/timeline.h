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
    uint64_t value() const noexcept; // current value; 0 on an error, which wait() reports
    // Throws DeviceLost; keeps waiting if memory is short. On GPUs polls for kPollTime before it sleeps,
    // because a wake-up by the kernel takes as long as half of a frame's passes.
    void wait(uint64_t value) const;

    static constexpr double kPollTime = 2e-3; // [s] polling time

private:
    bool comesSoon(uint64_t value) const;

    const Device& device_;
    VkSemaphore handle_ = VK_NULL_HANDLE;
};

} // namespace fathom::gpu
