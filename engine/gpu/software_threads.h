// SPDX-License-Identifier: Apache-2.0
// The number of threads of Mesa's software device (llvmpipe).
#pragma once

#include <cstdint>
#include <optional>

namespace fathom::gpu {

// The number of threads to request on so many processors; empty where the driver's default, one thread per
// processor, is as good. On two processors the kernel often wakes both threads on the same one, because the
// waking thread still occupies the other, and a pass ends before the kernel balances them. Four threads
// spread over both.
std::optional<uint32_t> softwareThreads(uint32_t processors) noexcept;

// Sets Mesa's environment variable LP_NUM_THREADS, unless it is set; Mesa reads it when devices are listed.
// Call in a program before threads start. A library must not change the environment.
void askForSoftwareThreads() noexcept;

} // namespace fathom::gpu
