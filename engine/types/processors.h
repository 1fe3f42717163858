// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace fathom {

// How many CPUs the calling thread may run on now (sched_setaffinity(2), cpusets), at least one. The standard
// library's count is the machine's.
uint32_t usableProcessors() noexcept;

} // namespace fathom
