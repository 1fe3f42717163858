// SPDX-License-Identifier: Apache-2.0
// Starts this program again as a separate process for one task.
#pragma once

#include <chrono>
#include <span>
#include <sys/types.h>

namespace fathom {

inline constexpr int kNullDevice = -2; // means /dev/null in a list of descriptors

// Runs this program with the given arguments, the first its name and the last nullptr. files[i], at most 8,
// becomes descriptor i; no other descriptor is inherited, because the process must not keep a camera or a GPU
// open. A standard error that was closed at our start is /dev/null there. The process has its own session and
// default signals, so Ctrl-C and a closed terminal only reach the engine. Returns an errno value, 0 when
// `process` runs.
int startOwnProcess(pid_t& process, std::span<const int> files, std::span<const char* const> words) noexcept;

// Waits for a child process to end and reaps it, at most for `timeout`. False: it still runs then.
bool waitForEnd(pid_t process, std::chrono::milliseconds timeout) noexcept;

} // namespace fathom
