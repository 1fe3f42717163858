// SPDX-License-Identifier: Apache-2.0
// This program started again, as a process beside it that does one thing.
#pragma once

#include <span>
#include <sys/types.h>

namespace fathom {

inline constexpr int kNullDevice = -2; // stands for /dev/null among descriptors

// Runs this program with those words, the first its name and the last nullptr. files[i], at most 8, is its
// descriptor i, and none else of ours: it must not keep a camera or a GPU open. A standard error that was
// closed when we began is /dev/null there, whatever has its number now. In a session of its own, with the
// usual signals: Ctrl-C and a closed terminal are the engine's. Returns errno's number, 0 when `process`
// runs.
int startOwnProcess(pid_t& process, std::span<const int> files, std::span<const char* const> words) noexcept;

} // namespace fathom
