// SPDX-License-Identifier: Apache-2.0
// The ticks of a recording: hand.csv with raw poses and buttons, and the files of tick_log.h.
#pragma once

#include "devices/recorded/line_file.h"
#include "engine/run/channels.h"

#include <deque>
#include <filesystem>

namespace fathom::operate {

// One thread at a time. Every call throws Error that names the file.
class RecordedTicks {
public:
    // Begins a recording.
    void open(const std::filesystem::path& folder);
    // marked: the pilot has marked this tick.
    void add(const TickRow& row, bool marked) { waiting_.push_back({row, marked}); }
    uint64_t bytes() const { return hand_.size() + wrench_.size() + touches_.size(); } // written
    void drop() { waiting_.clear(); }                                                  // the ticks that wait
    bool waits() const { return !waiting_.empty(); }
    // Image number `image` of the recording is the run's frame `frame`.
    void number(int64_t frame, uint64_t image);
    // Writes the waiting ticks of [from, to) in the run; `from` is at `start` in the recording, and time runs
    // `scale` times as fast there [s].
    void flush(double from, double to, double start, double scale);

private:
    struct Waiting {
        TickRow row;
        bool marked = false;
    };
    void put(const Waiting& tick, double t);
    int64_t imageOf(int64_t frame) const; // -1 = from before the recording

    std::deque<Waiting> waiting_;                      // since the last frame
    std::deque<std::pair<int64_t, uint64_t>> numbers_; // frame in the run, image in the recording
    double last_ = -1.0;                               // [s] of the last written tick
    std::filesystem::path folder_;
    uint32_t marks_ = 0;
    LineFile hand_, wrench_, touches_, marksFile_; // the last one only with marks
};

} // namespace fathom::operate
