// SPDX-License-Identifier: Apache-2.0
// Processors that this process may use.
#pragma once

#include <cstdint>

namespace fathom {

// Number of CPUs on which the calling thread may run (sched_setaffinity(2), cpusets), at least one. The
// standard library counts those of the machine.
uint32_t usableProcessors() noexcept;

} // namespace fathom
