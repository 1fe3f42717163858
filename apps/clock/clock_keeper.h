// SPDX-License-Identifier: Apache-2.0
// Holds an NVIDIA GPU at its full clock while it waits for frames (--hold-clock). The driver lowers the
// clock of an idle device between frames, to a sixth, and raises it too late for a millisecond of passes,
// except while a CUDA context exists. A separate process creates one, so that the memory and threads of the
// CUDA driver stay out of the engine's process, whose memory is locked and whose threads are pinned.
#pragma once

#include "apps/global_options.h"
#include "engine/types/device_facts.h"

#include <array>
#include <string>
#include <sys/types.h>

namespace fathom {

// First argument that starts this process; it exits when its standard input closes.
inline constexpr const char* kKeepClockCommand = "keep-clock";
inline constexpr char kClockHeld = '1'; // its answer

// 32 hexadecimal digits.
std::string hexOf(const std::array<uint8_t, 16>& uuid);

// One thread.
class ClockKeeper {
public:
    // Starts the process when the options request it. A failure changes nothing else and logs one warning,
    // here or in that process.
    ClockKeeper(const GlobalOptions& options, const DeviceFacts& device);
    ClockKeeper(const ClockKeeper&) = delete;
    ClockKeeper& operator=(const ClockKeeper&) = delete;
    ~ClockKeeper(); // ends it without waiting for a hanging driver

    // For measurements: waits some seconds at most until the process reports whether the clock is held, and
    // ends it otherwise. Later calls report whether it still is.
    bool held() noexcept;

private:
    void end() noexcept;

    pid_t process_ = -1;
    int life_ = -1, answer_ = -1; // pipes: closed, it ends; kClockHeld
    bool held_ = false;
};

} // namespace fathom
