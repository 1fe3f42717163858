// SPDX-License-Identifier: Apache-2.0
// A guardian of an arm's line: a small process that has the line open beside the engine and writes nothing to
// it while the engine lives. When the engine ends without a farewell, or is silent, it tells the arm to stand
// still.
#pragma once

#include "devices/serial/stand_still.h"

namespace fathom {

// What comes over the pipe from the engine, and the one byte that goes back.
inline constexpr char kGuardAlive = 'a';
inline constexpr char kGuardFarewell = 'f';
inline constexpr char kGuardReady = 'r';

// When to write. Pure state; the caller brings the clock [s]. noexcept, no allocation, one thread.
class LineGuard {
public:
    explicit LineGuard(double period) noexcept // [s] between two times of telling the arm
        : period_(period) {}

    void alive(double now) noexcept; // from the first one on the arm may move
    void farewell() noexcept { parted_ = true; }
    void close() noexcept; // the engine has ended

    // The arm must be told now. Of a silence: until the engine is heard again; either way for kLastWords.
    bool mustTell(double now) noexcept;
    bool over(double now) const noexcept; // nothing is left to guard
    bool closed() const noexcept { return closed_; }
    int found() const noexcept { return found_; } // times that the engine was found dead or silent

    static constexpr double kSilence =
        0.2; // [s] of an engine that lives: ten commands of a Reach, four of an ECA
    static constexpr double kLastWords = 0.5; // [s] of telling the arm, every period

private:
    double period_;
    double heardAt_ = -1.0, toldSince_ = -1.0, next_ = 0.0; // [s]; negative: never
    bool parted_ = false, closed_ = false;
    int found_ = 0;
};

// Serves until the engine has ended. engine: a stream socket with the engine at its other end; line: open,
// not blocking. The kernel takes one write() after the other, so that the telegrams of two processes never
// mix. Returns how often the engine was found dead or silent.
int guardLine(int engine, int line, const StandStill& still) noexcept;

} // namespace fathom
