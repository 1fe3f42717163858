// SPDX-License-Identifier: Apache-2.0
// A timeline of a run as Chrome trace JSON (chrome://tracing, ui.perfetto.dev): spans and instants on named
// tracks.
#pragma once

#include "engine/types/spsc_queue.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace fathom {

// The clock of every event; shown as time since the trace was made.
using TraceTime = std::chrono::steady_clock::time_point;

// Something worth reading beside an event: a number, or a word when `word` is set. Null name = nothing. All
// texts must live as long as the trace: literals, or what Trace::keep() returned.
struct TraceDetail {
    const char* name = nullptr;
    double number = 0.0;
    const char* word = nullptr;
};

// One span or instant of a track.
struct TraceEvent {
    const char* name = nullptr;
    TraceTime begin{};
    std::chrono::nanoseconds length{0};
    TraceDetail detail;
    bool instant = false;
    bool frequent = false;
};

// One thread at a time writes a track. Wait-free, allocates nothing; an event that finds the ring full is
// lost and counted.
class TraceTrack {
public:
    TraceTrack(std::string name, uint64_t capacity)
        : name_(std::move(name))
        , ring_(capacity) {}

    void span(const char* name, TraceTime begin, TraceTime end, const TraceDetail& detail = {}) noexcept {
        ring_.push({name, begin, end - begin, detail, false, false});
    }
    // The same for what happens thousands of times a second: the first to be left out when the file grows.
    void frequentSpan(const char* name, TraceTime begin, TraceTime end,
                      const TraceDetail& detail = {}) noexcept {
        ring_.push({name, begin, end - begin, detail, false, true});
    }
    void instant(const char* name, TraceTime at, const TraceDetail& detail = {}) noexcept {
        ring_.push({name, at, {}, detail, true, false});
    }

private:
    friend class Trace;
    std::string name_;
    SpscQueue<TraceEvent> ring_;
};

// Tracks are added before their threads start; drain() and finish() belong to one other thread (or the same
// one, in lockstep). Frequent spans are all written while the file is small (half of maxBytes), after that
// only those of at least kLongSpan; at maxBytes nothing more is. What was left out is counted in the file.
class Trace {
public:
    // Throws Error that names the file. The file appears under its name at finish(): whole or not at all.
    explicit Trace(std::filesystem::path file, uint64_t maxBytes = 50'000'000);
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;
    ~Trace(); // finishes; a failure to write stays silent there

    TraceTrack& track(std::string name, uint64_t capacity = 8192);
    // A copy of the text that lives as long as the trace.
    const char* keep(std::string text);

    // Moves what the tracks hold into the file. Cheap when there is nothing; call it more often than the
    // rings fill.
    void drain();
    // Drains and closes the file. Throws Error that names it. Nothing may be traced after.
    void finish();

    static constexpr std::chrono::microseconds kLongSpan{100};

private:
    void write(const TraceEvent& event, size_t track);
    void writeNames();
    void put(const std::string& text);

    std::filesystem::path file_, temporary_;
    uint64_t maxBytes_;
    std::ofstream out_;
    uint64_t bytes_ = 0, written_ = 0, shortLeftOut_ = 0, leftOut_ = 0;
    bool finished_ = false;
    TraceTime start_;
    std::vector<std::unique_ptr<TraceTrack>> tracks_;
    std::vector<std::unique_ptr<std::string>> kept_;
};

} // namespace fathom
