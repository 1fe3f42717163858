// SPDX-License-Identifier: Apache-2.0
// Saves the ticks that led to a tick with a non-finite number: the last two seconds, in a separate file that
// exists even if the run never ends properly.
#pragma once

#include "engine/run/record_drain.h"

#include <filesystem>
#include <vector>

namespace fathom {

// Forwards everything to one sink on the writer thread. Allocates in the constructor only. At a non-finite
// tick, at most once per minute, writes fault-T.csv with the columns of haptics.csv, where T is the tick's
// run time [s]. If the file cannot be written, logs a warning and the run continues.
class FaultTrace final : public ForwardingSink {
public:
    // period: tick period [s]. `next` must outlive this.
    FaultTrace(std::filesystem::path folder, double period, RunSink& next);

    void step(const TickRow& row, const ObeyedSet& obeyed) override;

    static constexpr double kSeconds = 2.0; // [s] of ticks in a file
    static constexpr double kQuiet = 60.0;  // [s] minimum time between files

private:
    void keep(const TickRow& row);
    void write(double t) const;

    std::filesystem::path folder_;
    std::vector<StepRecord> ring_;
    uint64_t seen_ = 0; // ticks so far; the newest is at (seen_ - 1) % size
    double newest_ = 0.0, quietUntil_ = 0.0;
};

} // namespace fathom
