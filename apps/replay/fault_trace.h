// SPDX-License-Identifier: Apache-2.0
// What led to a tick with a number that is none: the ticks of the last two seconds, as a file of their own
// that is there whether or not the run comes to its end.
#pragma once

#include "apps/replay/tick_record.h"
#include "engine/run/record_drain.h"

#include <filesystem>
#include <vector>

namespace fathom {

// Hands everything on to one sink, on the writer thread, as all sinks; allocates when it is made. At a turn
// that is not finite, and at most once a minute after, it leaves fault-T.csv, T the time of that tick [s] in
// the run, with the columns of haptics.csv. One that cannot be written is a warning: the run goes on.
class FaultTrace final : public RunSink {
public:
    // period: of a tick [s]. `next` outlives this.
    FaultTrace(std::filesystem::path folder, double period, RunSink& next);

    void frame(const PublishedFrame& frame, const Fixtures& set) override { next_.frame(frame, set); }
    void query(const QueryNote& note) override { next_.query(note); }
    void step(const TickRow& row, const PublishedFrame* obeyed, bool known,
              std::span<const uint32_t> behind) override;

    static constexpr double kSeconds = 2.0; // that are kept
    static constexpr double kQuiet = 60.0;  // [s] between files

private:
    void keep(const TickRow& row);
    void write(double t) const;

    std::filesystem::path folder_;
    RunSink& next_;
    std::vector<TickRecord> ring_;
    uint64_t seen_ = 0; // turns; the newest lies at (seen_ - 1) % size
    double newest_ = 0.0, quietUntil_ = 0.0;
};

} // namespace fathom
