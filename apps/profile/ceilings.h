// SPDX-License-Identifier: Apache-2.0
// The machine's measured limits: bandwidth of device memory, of host memory read by the device, and of host
// copies, and the device's arithmetic rate.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

struct Ceilings {
    double deviceBytes = 0.0; // [B/s] device memory, best of copies (read plus written) and reads
    double uploadBytes = 0.0; // [B/s] device reads of memory that the CPU writes (MemoryKind::Upload)
    double importBytes = 0.0; // [B/s] device reads of imported host pages; 0 = cannot import
    bool oneMemory = false;   // device and host share one memory
    double deviceFlops = 0.0; // [1/s] float32; a fused multiply-add counts as two
    double hostBytes = 0.0;   // [B/s] read plus written by memcpy of one thread
    double workerBytes = 0.0; // [B/s] the same with hostThreads threads
    uint32_t hostThreads = 1;
    double dispatchMs = 0.0; // [ms] device time of an empty dispatch in a chain
    double submitMs = 0.0;   // [ms] p50 from an empty submission to its result
    std::string how;         // readable: sizes, and which method was best
};

// Each value is the best of several sizes and repeats after a warm-up; takes a few seconds in total. On a CPU
// device, each size takes a few milliseconds. Verifies computed, copied and read data. hostThreads: number of
// threads for host work. Throws Error.
Ceilings measureCeilings(gpu::Device& device, uint32_t hostThreads, const Repeats& repeats);

// Lower bound [ms] for a pass that moves `own` bytes of device memory and reads `images` bytes. inPlace: the
// images are in imported host pages, otherwise in upload memory. Separate memories work in parallel, a shared
// one does not.
double readingMs(const Ceilings& c, double own, double images, bool inPlace);

} // namespace fathom::profile
