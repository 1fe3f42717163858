// SPDX-License-Identifier: Apache-2.0
// A progress line on the terminal during a run, removed at its end.
#pragma once

#include "engine/types/clock.h"

#include <cstdint>
#include <cstdio>
#include <string>

namespace fathom {

struct ProgressCounts {
    uint64_t framesDone = 0, framesTotal = 0; // total 0 = unknown
    double runSeconds = 0.0;                  // [s] run time so far, on the run's own clock
    double runTotal = 0.0;                    // [s] when it will end; 0 = unknown
    bool framesOnly = false;                  // no ticks, and no clock of a run
};

// "frame 12 of 60, 5 s left, 31 frames/s, 1.40 x real time". The time left is
// shown from the first second on, by the run's time, else by its frames.
std::string progressText(const ProgressCounts& counts, double wallSeconds);

// Writes only when `out` is a terminal that can erase a line, and at most ten times per second, so update()
// may be called every tick and every frame. Never throws: a closed terminal must not fail a run.
class Progress {
public:
    explicit Progress(std::FILE* out = stderr);
    Progress(std::FILE* out, bool terminal);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() { finish(); }

    void update(const ProgressCounts& counts) noexcept;
    void finish() noexcept; // removes the line; may be called repeatedly

private:
    std::FILE* out_;
    bool terminal_;
    bool shown_ = false;
    uint32_t calls_ = 0;
    Clock::time_point start_ = Clock::now();
    Clock::time_point next_ = start_;
};

} // namespace fathom
