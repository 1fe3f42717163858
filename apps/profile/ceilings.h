// SPDX-License-Identifier: Apache-2.0
// What the machine can do at best: copy bandwidth and arithmetic rate of the device, copy bandwidth of the
// host.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

struct Ceilings {
    double deviceBytes = 0.0; // [B/s] read plus written by a copy between device buffers
    double deviceFlops = 0.0; // [1/s] float32, a multiply-add counts two
    double hostBytes = 0.0;   // [B/s] read plus written by memcpy of one thread
    double crewBytes = 0.0;   // [B/s] the same of hostThreads threads
    uint32_t hostThreads = 1;
    double submitMs = 0.0; // [ms] an empty submission until its result is known, p50
};

// Takes about a second. Verifies what was computed and copied. hostThreads: that share work on the host.
Ceilings measureCeilings(gpu::Device& device, uint32_t hostThreads, const Effort& effort);

} // namespace fathom::profile
