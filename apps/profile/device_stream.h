// SPDX-License-Identifier: Apache-2.0
// Memory bandwidth: the device copies and reads buffers of one memory kind and times it.
#pragma once

#include "apps/profile/spread.h"
#include "engine/gpu/commands.h"
#include "engine/gpu/stopwatch.h"

#include <functional>
#include <string>

namespace fathom::profile {

// Runs submissions one at a time and waits for each. For one thread.
class TimedSubmissions {
public:
    explicit TimedSubmissions(gpu::Device& device);
    // Device time [ms] of the commands that record() records; wall time if the device has no timestamps.
    double once(const std::function<void(gpu::Commands&)>& record);
    // The shortest time of several repeats after a warm-up, because a ceiling is the best that can be
    // reached.
    double best(const Repeats& repeats, const std::function<void(gpu::Commands&)>& record);
    double lastWallMs() const { return lastWallMs_; } // from submission to known completion

private:
    gpu::Device& device_;
    gpu::Timeline timeline_;
    gpu::Commands commands_;
    gpu::Stopwatch watch_;
    uint64_t ticket_ = 0;
    double lastWallMs_ = 0.0;
};

// Memory of a stream: `buffers` buffers of `bytes` each. On a GPU the total far exceeds its caches, and each
// buffer is below 128 MiB, the guaranteed storage buffer limit. On a CPU device one pass takes a few
// milliseconds.
struct StreamSize {
    uint64_t bytes = 0;
    uint32_t buffers = 1;
};
StreamSize streamSizeOf(const gpu::Device& device);

// Whether device and host share one memory.
bool oneMemory(const gpu::Device& device);

// The memory that the device reads.
enum class StreamMemory {
    Device, // device-local
    Upload, // written by the CPU, read by the device
    Import, // imported host pages
};

// The best rate and the method that reached it; 0 when this memory is not available.
struct StreamRate {
    double bytesPerSecond = 0.0;
    std::string way; // "copies of 4 x 128 MiB"
};
// Copies within device memory (copy command and compute pass) and reads by a pass. Counts both read and
// written bytes. Uses less memory if less is available, as does bestRead(). Throws Error when a copy or a sum
// is wrong.
StreamRate bestDeviceStream(gpu::Device& device, TimedSubmissions& submissions, const Repeats& repeats);
// Reads by a pass, and by the copy command into device memory. Written bytes count if both are the same
// memory. Throws Error when a sum is wrong.
StreamRate bestRead(gpu::Device& device, TimedSubmissions& submissions, StreamMemory memory,
                    const StreamSize& size, const Repeats& repeats);

} // namespace fathom::profile
