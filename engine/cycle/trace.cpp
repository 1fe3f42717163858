// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/trace.h"

#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/number_text.h"
#include "engine/types/replaceable.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace fathom {

namespace {

constexpr uint64_t kRoomForTheEnd = 4096; // [bytes] of maxBytes reserved for track names and counts

std::string number(double value) {
    return std::isfinite(value) ? significant(value, 9) : "null";
}

std::string micros(std::chrono::nanoseconds time) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3f", static_cast<double>(time.count()) * 1e-3);
    return text;
}

std::string arguments(const TraceDetail& detail) {
    if (detail.name == nullptr) {
        return {};
    }
    const std::string value = detail.word != nullptr ? doubleQuoted(detail.word) : number(detail.number);
    return ",\"args\":{" + doubleQuoted(detail.name) + ":" + value + "}";
}

// The finished trace replaces this file, so the name must be free or a regular file.
std::filesystem::path replaceable(std::filesystem::path file) {
    if (!isReplaceable(file)) {
        throw Error("trace " + file.string() + ": cannot be written: a folder, a device or a pipe");
    }
    refuseInput(file);
    return file;
}

} // namespace

Trace::Trace(std::filesystem::path file, uint64_t maxBytes)
    : file_(replaceable(std::move(file)))
    , temporary_(file_.string() + ".part")
    , maxBytes_(maxBytes)
    , out_(temporary_, std::ios::binary | std::ios::trunc)
    , start_(std::chrono::steady_clock::now()) {
    if (!out_) {
        throw BadInput("trace", file_.string(), std::strerror(errno), "a file that can be written");
    }
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
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
    bytes_ += text.size();
}

void Trace::write(const TraceEvent& event, size_t track) {
    if (event.frequent && event.length < kLongSpan && bytes_ > maxBytes_ / 2) {
        ++shortLeftOut_;
        return;
    }
    const std::string place =
        ",\"pid\":1,\"tid\":" + std::to_string(track + 1) + ",\"ts\":" + micros(event.begin - start_);
    const std::string kind =
        event.instant ? ",\"ph\":\"i\",\"s\":\"t\"" : ",\"ph\":\"X\",\"dur\":" + micros(event.length);
    const std::string text =
        ",\n{\"name\":" + doubleQuoted(event.name) + kind + place + arguments(event.detail) + "}";
    if (bytes_ + text.size() + kRoomForTheEnd > maxBytes_) {
        ++leftOut_;
        return;
    }
    put(text);
    ++written_;
}

void Trace::drain() {
    TraceEvent event;
    for (size_t i = 0; i < tracks_.size(); ++i) {
        while (tracks_[i]->ring_.pop(event)) {
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
        lost += track->ring_.dropped();
    }
    put("\n],\"otherData\":{\"events\":" + std::to_string(written_) +
        ",\"short_frequent_spans_left_out\":" + std::to_string(shortLeftOut_) +
        ",\"left_out_for_size\":" + std::to_string(leftOut_) + ",\"lost\":" + std::to_string(lost) + "}}\n");
    out_.close();
    std::error_code fault;
    if (out_) {
        std::filesystem::rename(temporary_, file_, fault);
    }
    if (!out_ || fault) {
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
        throw Error("trace " + file_.string() + ": cannot be written");
    }
}

} // namespace fathom
