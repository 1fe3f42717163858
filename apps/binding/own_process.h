// SPDX-License-Identifier: Apache-2.0
// This program started again, as a process beside it that does one thing.
#pragma once

#include <span>
#include <sys/types.h>

namespace fathom {

inline constexpr int kNullDevice = -1; // stands for /dev/null among descriptors

// Runs `fathom WORDS...` with files[i] as its descriptor i (at most 8; a standard error that is closed is
// /dev/null there) and none else of ours: it must not keep a camera or a GPU open. In a session of its own,
// with the usual signals: Ctrl-C and a closed terminal are the engine's. words: ends in nullptr. Returns
// errno's number, 0 when `process` runs.
int startOwnProcess(pid_t& process, std::span<const int> files, std::span<const char* const> words) noexcept;

} // namespace fathom
