// SPDX-License-Identifier: Apache-2.0
// Counts calls of operator new in this test program, to show that a haptic step makes none.
#pragma once

#include <cstdint>

namespace fathom {

uint64_t allocationCount() noexcept;       // since the program's start, all threads
uint64_t threadAllocationCount() noexcept; // of the calling thread

} // namespace fathom
