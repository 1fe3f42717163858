// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/cadence_trace.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "tests/rig/file_size_limit.h"
#include "tests/support/scratch_folder.h"

#include <atomic>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

using namespace fathom;
using Json = nlohmann::json;

namespace {

struct TraceFile {
    Json read() const { return Json::parse(folder.read("run.json")); }
    testing::ScratchFolder folder;
    std::filesystem::path path = folder / "run.json";
};

std::vector<Json> eventsNamed(const Json& trace, const std::string& name) {
    std::vector<Json> found;
    for (const Json& event : trace["traceEvents"]) {
        if (event["name"] == name) {
            found.push_back(event);
        }
    }
    return found;
}

constexpr std::chrono::microseconds us(int64_t n) {
    return std::chrono::microseconds(n);
}

} // namespace

TEST_CASE("A trace without events is a valid file that names the process") {
    TraceFile file;
    { Trace trace(file.path); }
    const Json json = file.read();
    CHECK(json["traceEvents"].size() == 1);
    CHECK(json["traceEvents"][0]["ph"] == "M");
    CHECK(json["otherData"]["events"] == 0);
}

TEST_CASE("Spans and instants have their times in microseconds, their track and their detail") {
    TraceFile file;
    Trace trace(file.path);
    TraceTrack& first = trace.track("first \"track\"");
    TraceTrack& second = trace.track("second");
    const auto t = std::chrono::steady_clock::now();
    first.span("span", t, t + us(1500), {"count", 42.5});
    second.span("span", t + us(250), t + us(251));
    second.instant("instant", t + us(1000), {"why", 0.0, "a\\b"});
    second.instant("odd", t, {"value", std::nan("")});
    trace.finish();

    const Json json = file.read();
    const auto spans = eventsNamed(json, "span");
    REQUIRE(spans.size() == 2);
    CHECK(spans[0]["ph"] == "X");
    CHECK(spans[0]["dur"] == 1500.0);
    CHECK(spans[0]["args"]["count"] == 42.5);
    CHECK(spans[0]["pid"] == 1);
    CHECK(spans[1]["tid"] != spans[0]["tid"]);
    CHECK(spans[1]["ts"].get<double>() - spans[0]["ts"].get<double>() ==
          doctest::Approx(250.0).epsilon(1e-6));
    const auto instant = eventsNamed(json, "instant").at(0);
    CHECK(instant["ph"] == "i");
    CHECK(instant["args"]["why"] == "a\\b");
    CHECK(!instant.contains("dur"));
    CHECK(eventsNamed(json, "odd").at(0)["args"]["value"].is_null());
    std::map<int, std::string> names;
    for (const Json& event : eventsNamed(json, "thread_name")) {
        names[event["tid"]] = event["args"]["name"];
    }
    CHECK(names[spans[0]["tid"]] == "first \"track\"");
    CHECK(names[spans[1]["tid"]] == "second");
}

TEST_CASE("The file stays within its bound: short frequent spans are dropped first, long ones are kept, all "
          "are counted") {
    TraceFile file;
    constexpr uint64_t kBound = 60'000;
    constexpr int kTurns = 3000;
    Trace trace(file.path, kBound);
    TraceTrack& track = trace.track("turns");
    const auto t = std::chrono::steady_clock::now();
    for (int i = 0; i < kTurns; ++i) {
        const bool isLong = i % 100 == 99;
        track.frequentSpan(isLong ? "long" : "short", t + us(1000 * i),
                           t + us(1000 * i + (isLong ? 100 : 99)));
        trace.drain();
    }
    trace.finish();
    CHECK(std::filesystem::file_size(file.path) <= kBound);
    CHECK(std::filesystem::file_size(file.path) > kBound / 2);
    const Json json = file.read();
    CHECK(eventsNamed(json, "long").size() == kTurns / 100);
    const size_t shorts = eventsNamed(json, "short").size();
    CHECK(shorts > 100);
    const Json& counts = json["otherData"];
    CHECK(counts["short_frequent_spans_left_out"] == kTurns - kTurns / 100 - shorts);
    CHECK(counts["left_out_for_size"] == 0);
    CHECK(counts["events"] == shorts + kTurns / 100);
}

TEST_CASE("Beyond the bound nothing more is written and the file is still valid") {
    TraceFile file;
    Trace trace(file.path, 8192);
    TraceTrack& track = trace.track("busy", 1024);
    const auto t = std::chrono::steady_clock::now();
    for (int i = 0; i < 500; ++i) {
        track.span("always", t, t + us(5));
    }
    trace.finish();
    CHECK(std::filesystem::file_size(file.path) <= 8192);
    const Json json = file.read();
    const size_t written = eventsNamed(json, "always").size();
    CHECK(written > 10);
    CHECK(json["otherData"]["left_out_for_size"] == 500 - written);
}

TEST_CASE("Events are dropped and counted when the queue is full") {
    TraceFile file;
    Trace trace(file.path);
    TraceTrack& track = trace.track("small", 4);
    const auto t = std::chrono::steady_clock::now();
    for (int i = 0; i < 11; ++i) {
        track.instant("tick", t);
    }
    trace.finish();
    const Json json = file.read();
    CHECK(eventsNamed(json, "tick").size() == 4);
    CHECK(json["otherData"]["lost"] == 7);
}

TEST_CASE("Tracks of several threads are collected while they write") {
    TraceFile file;
    constexpr int kThreads = 3, kEvents = 20'000;
    Trace trace(file.path);
    std::atomic<int> running{kThreads};
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i) {
        TraceTrack& track = trace.track("thread " + std::to_string(i));
        threads.emplace_back([&track, &running] {
            for (int k = 0; k < kEvents; ++k) {
                track.instant("event", std::chrono::steady_clock::now());
                if (k % 1000 == 0) {
                    std::this_thread::sleep_for(us(500));
                }
            }
            running.fetch_sub(1);
        });
    }
    while (running.load() > 0) {
        trace.drain();
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    trace.finish();
    const Json json = file.read();
    std::map<int, double> last;
    size_t events = 0;
    for (const Json& event : eventsNamed(json, "event")) {
        const int track = event["tid"];
        const double ts = event["ts"];
        CHECK(ts >= last[track]); // in order within a track
        last[track] = ts;
        ++events;
    }
    CHECK(last.size() == kThreads);
    CHECK(events + json["otherData"]["lost"].get<size_t>() == kThreads * kEvents);
}

TEST_CASE("A frame's passes follow each other from its submission on, on the device's track") {
    TraceFile file;
    CadenceTrace trace(file.path, {"classify", "surface"});
    FrameReport report;
    const auto t = std::chrono::steady_clock::now();
    report.index = 7;
    report.times = {t, t + us(100), t + us(150), t + us(5000), t + us(5400), t + us(6000)};
    report.passMs = {1.5, 2.25};
    trace.frame(report);
    report.unchanged = true;
    trace.frame(report);
    trace.query(t, t + us(3), 12);
    trace.step(t, t + us(4), 5e-6);
    trace.file().finish();

    const Json json = file.read();
    CHECK(eventsNamed(json, "captured").size() == 2);
    CHECK(eventsNamed(json, "captured")[0]["args"]["index"] == 7);
    REQUIRE(eventsNamed(json, "classify").size() == 1); // an unchanged frame has no passes
    const Json upload = eventsNamed(json, "upload")[0], classify = eventsNamed(json, "classify")[0];
    const Json surface = eventsNamed(json, "surface")[0];
    const double start = upload["ts"];
    CHECK(classify["ts"].get<double>() - start == doctest::Approx(150.0).epsilon(1e-6));
    CHECK(classify["dur"] == 1500.0);
    CHECK(surface["ts"].get<double>() - start == doctest::Approx(1650.0).epsilon(1e-6));
    CHECK(surface["dur"] == 2250.0);
    CHECK(surface["tid"] == classify["tid"]);
    CHECK(surface["tid"] != upload["tid"]);
    CHECK(surface["args"]["placed"].get<std::string>().find("submit time") != std::string::npos);
    CHECK(eventsNamed(json, "publish")[0]["dur"] == 1000.0);
    CHECK(eventsNamed(json, "grid")[0]["dur"] == 600.0);
    CHECK(eventsNamed(json, "query")[0]["args"]["spheres"] == 12);
    CHECK(eventsNamed(json, "turn")[0]["args"]["woken_late_us"] == doctest::Approx(5.0));
}

TEST_CASE("A trace that cannot be written is reported by name, and an earlier one stays until the new one is "
          "complete") {
    CHECK_THROWS_WITH_AS(
        Trace("/no/such/folder/run.json"),
        "trace: file: /no/such/folder/run.json: cannot create: No such file or directory (allowed: a file "
        "that can be written)",
        BadInput);
    TraceFile file;
    const std::string folder = file.folder.path().string();
    const std::string fault = ": cannot replace: a folder (allowed: a file that can be written)";
    CHECK_THROWS_WITH_AS(Trace(file.folder.path()), ("trace: file: " + folder + fault).c_str(), BadInput);
    CHECK_THROWS_WITH_AS(
        Trace("/dev/full"),
        "trace: file: /dev/full: cannot replace: a device or a pipe (allowed: a file that can be written)",
        Error);
    std::ofstream(file.path) << "{\"traceEvents\":[]}";
    Trace trace(file.path);
    trace.track("t").instant("tick", std::chrono::steady_clock::now());
    trace.drain();
    CHECK(file.read()["traceEvents"].empty());
    trace.finish();
    CHECK(eventsNamed(file.read(), "tick").size() == 1);
    CHECK(std::distance(std::filesystem::directory_iterator(file.folder.path()), {}) == 1);
}

TEST_CASE("A trace does not replace a file that was read while it was recorded, and follows no link") {
    TraceFile file;
    file.folder.write("hand.csv", "0 0 0 0\n");
    std::filesystem::create_symlink(file.folder / "hand.csv", file.folder / "run.json.part");
    std::filesystem::create_symlink(file.folder / "hand.csv", file.folder / "run.json.partial");
    Trace(file.path).finish();
    CHECK(file.folder.read("hand.csv") == "0 0 0 0\n");
    CHECK(std::filesystem::is_regular_file(std::filesystem::symlink_status(file.path)));

    Trace over(file.folder / "hand.csv");
    noteInput(file.folder / "hand.csv");
    CHECK_THROWS_AS(over.finish(), BadInput);
    CHECK(file.folder.read("hand.csv") == "0 0 0 0\n");
}

TEST_CASE("A disk that is full is reported at the end of the trace, not while events are collected") {
    TraceFile file;
    std::ofstream(file.path) << "old";
    {
        const FileSizeLimit small(1000);
        Trace trace(file.path, 10'000'000);
        TraceTrack& track = trace.track("busy", 8192);
        for (int i = 0; i < 30; ++i) { // more than the write buffer
            for (int k = 0; k < 1000; ++k) {
                track.instant("an event with a name of some length", std::chrono::steady_clock::now());
            }
            CHECK_NOTHROW(trace.drain());
        }
        CHECK_THROWS_AS(trace.finish(), Error);
    }
    CHECK(file.folder.read("run.json") == "old");
    CHECK(std::distance(std::filesystem::directory_iterator(file.folder.path()), {}) == 1);
}
