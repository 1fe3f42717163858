// SPDX-License-Identifier: Apache-2.0
// Holds an NVIDIA GPU at its full clock while it waits for pictures (--hold-clock). Its driver lowers the
// clock of a device that is asked little, to a sixth between pictures, and raises it too late for a
// millisecond of passes; it does not while a CUDA context exists. A process of its own makes one and nothing
// else: what that driver reserves and starts is then no part of a process whose memory is locked and whose
// threads are placed.
#pragma once

#include "apps/global_options.h"
#include "engine/types/device_facts.h"

#include <array>
#include <string>
#include <sys/types.h>

namespace fathom {

// The program's own first argument for that process; it ends with its standard input.
inline constexpr const char* kKeepClockCommand = "keep-clock";
inline constexpr char kClockHeld = '1'; // its answer

// 32 hexadecimal digits.
std::string hexOf(const std::array<uint8_t, 16>& uuid);

// One thread.
class ClockKeeper {
public:
    // Starts the process when the options ask for it. Without it everything is as always, and one warning
    // says why, here or from there.
    ClockKeeper(const GlobalOptions& options, const DeviceFacts& device);
    ClockKeeper(const ClockKeeper&) = delete;
    ClockKeeper& operator=(const ClockKeeper&) = delete;
    ~ClockKeeper(); // ends it; a driver that hangs is not waited for

    // Waits until it has said whether the clock is held, for some seconds at most, and then ends it: for who
    // measures. Later: whether it is still.
    bool held() noexcept;

private:
    void end() noexcept;

    pid_t process_ = -1;
    int life_ = -1, answer_ = -1; // pipes: closed, it ends; kClockHeld
    bool held_ = false;
};

} // namespace fathom
