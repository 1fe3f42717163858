// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/trace.h"

#include "engine/types/error.h"
#include "engine/types/number_text.h"
#include "engine/types/printed.h"
#include "engine/types/replaceable.h"

#include <cmath>

namespace fathom {

namespace {

constexpr uint64_t kRoomForTheEnd = 4096; // [bytes] of maxBytes reserved for track names and counts

std::string number(double value) {
    return std::isfinite(value) ? significant(value, 9) : "null";
}

std::string micros(std::chrono::nanoseconds time) {
    return printed("%.3f", static_cast<double>(time.count()) * 1e-3);
}

std::string arguments(const TraceDetail& detail) {
    if (detail.name == nullptr) {
        return {};
    }
    const std::string value = detail.word != nullptr ? doubleQuoted(detail.word) : number(detail.number);
    return ",\"args\":{" + doubleQuoted(detail.name) + ":" + value + "}";
}

OutputFile openTraceFile(const std::filesystem::path& file) {
    constexpr const char* kAllowed = "a file that can be written";
    if (std::error_code unknown; std::filesystem::is_directory(file, unknown)) {
        throw BadInput("trace", "file", file.string() + ": cannot replace: a folder", kAllowed);
    }
    if (!isReplaceable(file)) {
        throw Error("trace: file: " + file.string() +
                    ": cannot replace: a device or a pipe (allowed: " + kAllowed + ")");
    }
    try {
        return OutputFile(file);
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput("trace", "file", e.what(), kAllowed);
    }
}

} // namespace

Trace::Trace(const std::filesystem::path& file, uint64_t maxBytes)
    : out_(openTraceFile(file))
    , maxBytes_(maxBytes)
    , start_(std::chrono::steady_clock::now()) {
    put("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n");
    put(R"({"ph":"M","name":"process_name","pid":1,"tid":0,"args":{"name":"fathom"}})");
}

Trace::~Trace() {
    try {
        finish();
    } catch (...) { // must not hide the run's own error
    }
}

TraceTrack& Trace::track(std::string name, uint64_t capacity) {
    tracks_.push_back(std::make_unique<TraceTrack>(std::move(name), capacity));
    return *tracks_.back();
}

const char* Trace::keep(std::string text) {
    kept_.push_back(std::make_unique<std::string>(std::move(text)));
    return kept_.back()->c_str();
}

void Trace::put(const std::string& text) {
    if (!fault_.empty()) {
        return;
    }
    try {
        out_.write(text);
        bytes_ += text.size();
    } catch (const Error& e) { // a full disk must not end the run
        fault_ = e.what();
    }
}

void Trace::write(const TraceEvent& event, size_t track) {
    if (event.frequent && event.length < kLongSpan && bytes_ > maxBytes_ / 2) {
        ++droppedShort_;
        return;
    }
    const std::string place =
        ",\"pid\":1,\"tid\":" + std::to_string(track + 1) + ",\"ts\":" + micros(event.begin - start_);
    const std::string kind =
        event.instant ? ",\"ph\":\"i\",\"s\":\"t\"" : ",\"ph\":\"X\",\"dur\":" + micros(event.length);
    const std::string text =
        ",\n{\"name\":" + doubleQuoted(event.name) + kind + place + arguments(event.detail) + "}";
    if (bytes_ + text.size() + kRoomForTheEnd > maxBytes_) {
        ++droppedForSize_;
        return;
    }
    put(text);
    ++written_;
}

void Trace::drain() {
    TraceEvent event;
    for (size_t i = 0; i < tracks_.size(); ++i) {
        while (tracks_[i]->queue_.pop(event)) {
            write(event, i);
        }
    }
}

// Writes track names and keeps the tracks in the order in which they were added.
void Trace::writeNames() {
    for (size_t i = 0; i < tracks_.size(); ++i) {
        const std::string where = ",\"pid\":1,\"tid\":" + std::to_string(i + 1) + ",\"args\":{";
        put(",\n{\"ph\":\"M\",\"name\":\"thread_name\"" + where +
            "\"name\":" + doubleQuoted(tracks_[i]->name_.c_str()) + "}}");
        put(",\n{\"ph\":\"M\",\"name\":\"thread_sort_index\"" + where +
            "\"sort_index\":" + std::to_string(i) + "}}");
    }
}

void Trace::finish() {
    if (finished_) {
        return;
    }
    finished_ = true;
    drain();
    writeNames();
    uint64_t lost = 0;
    for (const auto& track : tracks_) {
        lost += track->queue_.dropped();
    }
    put("\n],\"otherData\":{\"events\":" + std::to_string(written_) + ",\"short_frequent_spans_left_out\":" +
        std::to_string(droppedShort_) + ",\"left_out_for_size\":" + std::to_string(droppedForSize_) +
        ",\"lost\":" + std::to_string(lost) + "}}\n");
    if (!fault_.empty()) {
        throw Error("trace " + fault_);
    }
    out_.commit();
}

} // namespace fathom
