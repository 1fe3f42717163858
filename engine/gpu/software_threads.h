// SPDX-License-Identifier: Apache-2.0
// How many threads Mesa's software device works with.
#pragma once

#include <cstdint>
#include <optional>

namespace fathom::gpu {

// What to ask of the software device that may run on so many processors; nothing where its own choice, a
// thread for each, is as good. On two the kernel often wakes both threads on one processor, for the other is
// busy until who wakes them sleeps, and a pass is over before that is put right; of four some end up on each.
std::optional<uint32_t> softwareThreads(uint32_t processors) noexcept;

// Asks by the environment variable LP_NUM_THREADS (Mesa's, read when a device is listed), unless it is set
// already. To be called before there are threads, by a program: a library changes no environment.
void askForSoftwareThreads() noexcept;

} // namespace fathom::gpu
