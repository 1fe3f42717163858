// SPDX-License-Identifier: Apache-2.0
// GPU timestamps: marks written between passes, read after the submission has completed.
#pragma once

#include "engine/gpu/device.h"

namespace fathom::gpu {

// Counts from one timestamp to a later one, of counters that begin again at 0 after 2^bits. 0 if `to` is the
// earlier one: a device may take markReached() before an earlier mark(), which waits for more.
uint64_t stampsBetween(uint64_t from, uint64_t to, uint32_t bits) noexcept;

// The marks of one submission. Reset on the host, so that the reset does not count in the frame's time.
class Stopwatch {
public:
    Stopwatch(const Device& device, uint32_t marks);
    ~Stopwatch();
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

    bool supported() const { return pool_ != VK_NULL_HANDLE; } // false: the device has no timestamps
    // Call before recording marks. No submission with marks may be in flight.
    void reset();
    // Call before submitting the same commands again. The same condition applies.
    void resetForResubmit() const;
    void mark(VkCommandBuffer commands); // taken after all work recorded so far
    // Taken when the device reaches the next command, even if earlier work still runs. For overlapping
    // passes, which mark() would serialise.
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
