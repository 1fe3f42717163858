// SPDX-License-Identifier: Apache-2.0
// Memory under load: buffers of one kind that the device copies and reads, timed by the device.
#pragma once

#include "apps/profile/spread.h"
#include "engine/gpu/commands.h"
#include "engine/gpu/stopwatch.h"

#include <functional>
#include <string>
#include <vector>

namespace fathom::profile {

// Submissions one after the other, each waited for. One thread.
class TimedSubmissions {
public:
    explicit TimedSubmissions(gpu::Device& device);
    // Device time of what record() records [ms]; wall time where the device has no timestamps.
    double once(const std::function<void(gpu::Commands&)>& record);
    // The shortest of several after a warm-up: a ceiling is what can be reached.
    double best(const Repeats& repeats, const std::function<void(gpu::Commands&)>& record);
    double lastWallMs() const { return lastWallMs_; } // from submission until it was known to have ended

private:
    gpu::Device& device_;
    gpu::Timeline timeline_;
    gpu::Commands commands_;
    gpu::Stopwatch watch_;
    uint64_t ticket_ = 0;
    double lastWallMs_ = 0.0;
};

// How much memory a stream takes: `buffers` of `bytes` each. A GPU's are far larger than its caches together
// and each below 128 MiB, the least limit of a storage buffer; a CPU's are read in a few milliseconds.
struct StreamSize {
    uint64_t bytes = 0;
    uint32_t buffers = 1;
};
StreamSize streamSizeOf(const gpu::Device& device);

// Whether the device's memory is the host's.
bool oneMemory(const gpu::Device& device);

// Which memory is read.
enum class StreamMemory {
    Device, // the device's own
    Upload, // that the CPU writes and the device reads
    Import, // pages of the host's own
};

// The best rate and how it came about; 0 where none of that memory can be had.
struct StreamRate {
    double bytesPerSecond = 0.0;
    std::string way; // "copies of 4 x 128 MiB"
};
// Copies within the device's memory, by its copy command and by a pass, and reads by a pass; read and written
// bytes both count. Takes less memory where there is less, as does bestRead(). Throws Error when a copy or a
// sum is wrong.
StreamRate bestDeviceStream(gpu::Device& device, TimedSubmissions& submissions, const Repeats& repeats);
// Reads by a pass, and by the copy command into the device's memory: what it writes counts where that is the
// same memory. Throws Error when a sum is wrong.
StreamRate bestRead(gpu::Device& device, TimedSubmissions& submissions, StreamMemory memory,
                    const StreamSize& size, const Repeats& repeats);

} // namespace fathom::profile
