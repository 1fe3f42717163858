// SPDX-License-Identifier: Apache-2.0
// Watchdog of an arm's serial line: a small process that also has the line open and writes nothing while the
// engine is alive. When the engine ends without a goodbye, or is silent, it stops the arm.
#pragma once

#include "devices/serial/stand_still.h"

namespace fathom {

// Messages from the engine, and the one byte that is sent back.
inline constexpr char kGuardAlive = 'a';
inline constexpr char kGuardFarewell = 'f';
inline constexpr char kGuardReady = 'r';

// Decides when to write. Pure state; the caller passes the time [s]. noexcept, no allocation, one thread.
class LineGuard {
public:
    explicit LineGuard(double period) noexcept // [s] between two stop telegrams
        : period_(period) {}

    void alive(double now) noexcept; // the arm may move after the first call
    void farewell() noexcept { parted_ = true; }
    void close() noexcept; // the engine's end is closed

    // True when a stop telegram is due: after a silence until the engine is back, and in any case for
    // kLastWords.
    bool mustTell(double now) noexcept;
    bool over(double now) const noexcept; // the watchdog can exit
    bool closed() const noexcept { return closed_; }
    int found() const noexcept { return found_; } // number of times the engine was dead or silent

    static constexpr double kSilence = 0.2;   // [s] allowed: ten command periods of a Reach, four of an ECA
    static constexpr double kLastWords = 0.5; // [s] of repeated stop telegrams

private:
    double period_;
    double heardAt_ = -1.0, toldSince_ = -1.0, next_ = 0.0; // [s]; negative = never
    bool parted_ = false, closed_ = false;
    int found_ = 0;
};

// Runs until the engine has ended. engine: a stream socket to the engine; line: open, non-blocking. The
// kernel serialises write() calls, so telegrams of two processes never interleave. Returns how often the
// engine was dead or silent.
int guardLine(int engine, int line, const StandStill& still) noexcept;

} // namespace fathom
