// SPDX-License-Identifier: Apache-2.0
// GPU timestamps: marks written between passes, read after the submission has ended.
#pragma once

#include "engine/gpu/device.h"

namespace fathom::gpu {

// One submission's worth of marks. Reset on the host: the device would do it within the frame that it times.
class Stopwatch {
public:
    Stopwatch(const Device& device, uint32_t marks);
    ~Stopwatch();
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

    bool works() const { return pool_ != VK_NULL_HANDLE; } // false: the device has no timestamps
    // Before marks are recorded; no submission of any may be in flight.
    void reset();
    // Before the same commands are submitted again; likewise.
    void again() const;
    void mark(VkCommandBuffer commands); // after all work recorded so far
    // When the device reaches the next command, even while earlier work runs: for passes that overlap, where
    // mark() would serialise them.
    void markReached(VkCommandBuffer commands);
    uint32_t marks() const { return used_; }

    // Milliseconds between mark i and mark i + 1; zeros when the device has no timestamps. Call after
    // completion.
    std::vector<double> intervalsMs() const;

private:
    void markAt(VkCommandBuffer commands, VkPipelineStageFlagBits stage);

    const Device& device_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    uint32_t capacity_ = 0, used_ = 0;
};

} // namespace fathom::gpu
