// SPDX-License-Identifier: Apache-2.0
// What the machine can do at best: bandwidth of the device's memory and of the host's as the device reads it,
// arithmetic rate of the device, copy bandwidth of the host.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

struct Ceilings {
    double deviceBytes =
        0.0; // [B/s] of the device's memory: the best of copies (read plus written) and reads
    double uploadBytes = 0.0; // [B/s] the device reads memory that the CPU writes (MemoryKind::Upload)
    double importBytes = 0.0; // [B/s] the device reads the host's own pages; 0 = it cannot import them
    bool oneMemory = false;   // these are one and the same memory
    double deviceFlops = 0.0; // [1/s] float32, a fused multiply-add counts two
    double hostBytes = 0.0;   // [B/s] read plus written by memcpy of one thread
    double workerBytes = 0.0; // [B/s] the same of hostThreads threads
    uint32_t hostThreads = 1;
    double dispatchMs = 0.0; // [ms] of the device: an empty dispatch in a chain
    double submitMs = 0.0;   // [ms] an empty submission until its result is known, p50
    std::string how;         // sizes and what came out best, for people
};

// Each is the best of several sizes and repeats after a warm-up, some seconds in all; on a CPU device sizes
// are those of a few milliseconds. Verifies what was computed, copied and read. hostThreads: that share work
// on the host. Throws Error.
Ceilings measureCeilings(gpu::Device& device, uint32_t hostThreads, const Repeats& repeats);

// Least time [ms] of a pass that moves `own` bytes of the device's memory and reads `images` bytes: where
// the camera left them, or where the CPU wrote them for the device. Two memories may be busy at once, one may
// not.
double readingMs(const Ceilings& c, double own, double images, bool inPlace);

} // namespace fathom::profile
