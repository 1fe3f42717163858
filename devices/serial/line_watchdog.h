// SPDX-License-Identifier: Apache-2.0
// Watchdog of an arm's serial line: a small process that also has the line open and writes nothing while the
// engine is alive. When the engine ends without a goodbye, or is silent, it stops the arm.
#pragma once

#include "devices/serial/stand_still.h"

namespace fathom {

// Messages from the engine, and the one byte that is sent back.
inline constexpr char kWatchdogAlive = 'a';
inline constexpr char kWatchdogGoodbye = 'f';
inline constexpr char kWatchdogReady = 'r';

// Decides when to write. Pure state; the caller passes the time [s]. noexcept, no allocation, one thread.
class LineWatchdog {
public:
    explicit LineWatchdog(double period) noexcept // [s] between two stop telegrams
        : period_(period) {}

    void alive(double now) noexcept; // the arm may move after the first call
    void goodbye() noexcept { ended_ = true; }
    void close() noexcept; // the engine's end is closed

    // True when a stop telegram is due: after a silence until the engine is back, and for kStopDuration after
    // the engine has ended.
    bool stopDue(double now) noexcept;
    bool over(double now) const noexcept; // the watchdog can exit
    bool closed() const noexcept { return closed_; }
    int failures() const noexcept { return failures_; } // number of times the engine was dead or silent

    static constexpr double kSilence = 0.2; // [s] allowed: ten command periods of a Reach, four of an ECA
    static constexpr double kStopDuration = 0.5; // [s] of repeated stop telegrams

private:
    double period_;
    double receivedAt_ = -1.0, stoppingSince_ = -1.0, next_ = 0.0; // [s]; negative = never
    bool ended_ = false, closed_ = false;
    int failures_ = 0;
};

// Runs until the engine has ended. engine: a stream socket to the engine; line: open, non-blocking. The
// kernel serialises write() calls, so telegrams of two processes never interleave. Returns how often the
// engine was dead or silent.
int watchLine(int engine, int line, const StandStill& still) noexcept;

} // namespace fathom
