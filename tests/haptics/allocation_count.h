// SPDX-License-Identifier: Apache-2.0
// Counts calls of operator new in this test program, to prove that a haptic step does not allocate, and makes
// one fail.
#pragma once

#include <cstdint>

namespace fathom {

uint64_t allocationCount() noexcept;       // since program start, all threads
uint64_t threadAllocationCount() noexcept; // of the calling thread
void failNextAllocation() noexcept;        // of the calling thread

} // namespace fathom
