// SPDX-License-Identifier: Apache-2.0
// Timeline of a run as Chrome trace JSON (chrome://tracing, ui.perfetto.dev): spans and instants on named
// tracks.
#pragma once

#include "engine/types/clock.h"
#include "engine/types/output_file.h"
#include "engine/types/spsc_queue.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fathom {

// Clock of all events; displayed as time since the trace was created.
using TraceTime = Clock::time_point;

// A detail of an event: a number, or a word when `word` is set. Null name = no detail. All texts must live as
// long as the trace: literals, or results of Trace::keep().
struct TraceDetail {
    const char* name = nullptr;
    double number = 0.0;
    const char* word = nullptr;
};

// One span or instant on a track.
struct TraceEvent {
    const char* name = nullptr;
    TraceTime begin{};
    std::chrono::nanoseconds length{0};
    TraceDetail detail;
    bool instant = false;
    bool frequent = false;
};

// One thread at a time writes a track. Wait-free, does not allocate. When the queue is full, events are
// dropped and counted.
class TraceTrack {
public:
    TraceTrack(std::string name, uint64_t capacity)
        : name_(std::move(name))
        , queue_(capacity) {}

    void span(const char* name, TraceTime begin, TraceTime end, const TraceDetail& detail = {}) noexcept {
        queue_.push({name, begin, end - begin, detail, false, false});
    }
    // The same for events at thousands per second, which are dropped first when the file grows.
    void frequentSpan(const char* name, TraceTime begin, TraceTime end,
                      const TraceDetail& detail = {}) noexcept {
        queue_.push({name, begin, end - begin, detail, false, true});
    }
    void instant(const char* name, TraceTime at, const TraceDetail& detail = {}) noexcept {
        queue_.push({name, at, {}, detail, true, false});
    }

private:
    friend class Trace;
    std::string name_;
    SpscQueue<TraceEvent> queue_;
};

// Add tracks before their threads start. One other thread (in lockstep the same one) calls drain() and
// finish(). Up to half of maxBytes all frequent spans are written, then only those of at least kLongSpan, and
// nothing beyond maxBytes. The file counts the dropped events.
class Trace {
public:
    // Throws Error that names the file. Only finish() replaces a file of this name.
    explicit Trace(const std::filesystem::path& file, uint64_t maxBytes = 50'000'000);
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;
    ~Trace(); // finishes; ignores a failure to write

    TraceTrack& track(std::string name, uint64_t capacity = 8192);
    // A copy of the text that lives as long as the trace.
    const char* keep(std::string text);

    // Moves the events of all tracks to the file. Cheap without events; call it before the queues fill up.
    void drain();
    // Drains and closes the file. No events may follow. Throws Error that names it, also if the disk was full
    // before, or if this process has read the file since.
    void finish();

    static constexpr std::chrono::microseconds kLongSpan{100};

private:
    void write(const TraceEvent& event, size_t track);
    void writeNames();
    void put(const std::string& text);

    OutputFile out_;
    std::string fault_; // of the first write that failed
    uint64_t maxBytes_;
    uint64_t bytes_ = 0, written_ = 0, droppedShort_ = 0, droppedForSize_ = 0;
    bool finished_ = false;
    TraceTime start_;
    std::vector<std::unique_ptr<TraceTrack>> tracks_;
    std::vector<std::unique_ptr<std::string>> kept_;
};

} // namespace fathom
