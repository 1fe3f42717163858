// SPDX-License-Identifier: Apache-2.0
// `replay --realtime` on a recording, with threads, device and files.
#include "apps/replay/realtime_replay.h"

#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <csignal>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

using namespace fathom;
using namespace fathom::testing;
using Json = nlohmann::json;

namespace {

const std::filesystem::path kRecording = "../shared/data/valve_ball_d435";
constexpr double kPenetrationLimit = 1e-5; // [m]

bool recordingIsThere() {
    if (std::filesystem::exists(kRecording / "associations.txt")) {
        return true;
    }
    MESSAGE("SKIPPED: there is no recording " << kRecording);
    return false;
}

struct Run {
    explicit Run(const std::filesystem::path& out) {
        options.scene = "apps/scenes/valve_ball.yaml";
        options.source = kRecording.string();
        options.realtime = true;
        options.out = out;
        placement = ThreadPlacement::ofThisProcess();
        confined.emplace(placement.rest);
        session.emplace(options, GlobalOptions{});
        recorder.emplace(out, session->scene, RunSource{session->cycles.camera(), ""},
                         session->cycles.frames().passNames(), false);
        replay.emplace(*session, options, *recorder, placement, nullptr);
    }
    Json finish() {
        recorder->finish(replay->run());
        replay->rethrowFailure();
        return Json::parse(textOf(options.out / "summary.json"));
    }

    ReplayOptions options;
    ThreadPlacement placement;
    std::optional<CpuConfinement> confined;
    std::optional<Session> session;
    std::optional<ReplayRecorder> recorder;
    std::optional<RealtimeReplay> replay;
};

// Rows without the header; checks that each has all columns.
std::vector<std::vector<std::string>> rowsOf(const std::filesystem::path& csv, ptrdiff_t columns) {
    std::vector<std::vector<std::string>> rows;
    const std::string text = textOf(csv);
    CHECK(text.back() == '\n');
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        CHECK(std::count(line.begin(), line.end(), ',') == columns - 1);
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) {
            rows.back().push_back(cell);
        }
    }
    rows.erase(rows.begin());
    return rows;
}

constexpr ptrdiff_t kColumns = 45;
constexpr size_t kTime = 0, kFrame = 25, kAge = 26;

} // namespace

TEST_CASE("A realtime replay uses every frame of the recording, ages the scene by the clock and audits every "
          "tick") {
    if (!recordingIsThere()) {
        return;
    }
    ScratchFolder out;
    Run run(out.path());
    const Json summary = run.finish();
    CHECK(summary["lockstep"] == false);
    CHECK(summary["frames"]["count"] == 27);
    REQUIRE(summary["haptic"]["max_penetration_m"].is_number());
    CHECK(summary["haptic"]["max_penetration_m"].get<double>() <= kPenetrationLimit);
    CHECK(summary["haptic"]["turn_us"]["p50"].is_number());
    CHECK(run.replay->figures().wokenLateMicros.p50.has_value());
    CHECK(run.replay->figures().recordsLost == 0);
    const auto rows = rowsOf(out.path() / "haptics.csv", kColumns);
    CHECK(summary["haptic"]["ticks"] == rows.size());
    REQUIRE(rows.size() > 500);
    double oldest = 0.0;
    int64_t newest = -1;
    for (size_t i = 1; i < rows.size(); ++i) {
        CHECK(std::stod(rows[i][kTime]) > std::stod(rows[i - 1][kTime]));
        const double age = rows[i][kFrame] == "-1" ? 0.0 : std::stod(rows[i][kAge]);
        CHECK(age >= 0.0);
        oldest = std::max(oldest, age);
        newest = std::max<int64_t>(newest, std::stoll(rows[i][kFrame]));
    }
    CHECK(oldest > 0.01); // a frame needs this long through the passes
    CHECK(newest == 26);
    CHECK(rowsOf(out.path() / "frames.csv",
                 9 + static_cast<ptrdiff_t>(run.session->cycles.frames().passNames().size()) + 2)
              .size() == 27);
}

TEST_CASE("SIGINT ends a realtime replay early and leaves every file complete") {
    if (!recordingIsThere()) {
        return;
    }
    ScratchFolder out;
    Run run(out.path());
    std::thread user([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        ::kill(::getpid(), SIGINT);
    });
    const Json summary = run.finish();
    user.join();
    CHECK(run.replay->figures().stopped);
    CHECK(summary["warnings"].dump().find("ended by a signal at ") != std::string::npos);
    const auto rows = rowsOf(out.path() / "haptics.csv", kColumns);
    CHECK(summary["haptic"]["ticks"] == rows.size());
    CHECK(summary["frames"]["count"] < 27);
    for (const char* name : {"summary.json", "haptics.csv", "frames.csv", "traces.png", "overlay.png"}) {
        CHECK(std::filesystem::file_size(out.path() / name) > 0);
    }
    CHECK(out.files() == 6); // with the lock; no temporary file remains
}
