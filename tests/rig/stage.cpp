// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/stage.h"

#include "tests/rig/cause_check.h"
#include "tests/rig/summary_keys.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <set>

namespace fathom {

namespace {

using nlohmann::json;
using namespace testing;
namespace fs = std::filesystem;

void checkKeys(const json& object, Keys wanted) {
    Keys found; // sorted
    for (const auto& item : object.items()) {
        found.push_back(item.key());
    }
    std::sort(wanted.begin(), wanted.end());
    CHECK(found == wanted);
}

// Checks that measured times are positive and ordered, or null when nothing was measured.
void checkTimes(const json& times, const Keys& keys, bool measured) {
    checkKeys(times, keys);
    CHECK(times.at("p50").is_null() == !measured);
    if (measured) {
        CHECK(times.at("p50").get<double>() > 0.0);
        CHECK(times.at("p50").get<double>() <= times.at("p99").get<double>());
        CHECK(times.at("p99").get<double>() <= times.at("max").get<double>());
    }
}

// Checks the summary's percentiles against the column: nearest rank, rounded up.
void checkColumn(const json& times, std::vector<double> column) {
    checkKeys(times, kTimesKeys);
    REQUIRE(!column.empty());
    std::sort(column.begin(), column.end());
    const auto ofRank = [&](double share) {
        const double rank = std::ceil(share * static_cast<double>(column.size()));
        return doctest::Approx(column[static_cast<size_t>(rank) - 1]).epsilon(1e-6); // floats
    };
    CHECK(times.at("p50").get<double>() == ofRank(0.50));
    CHECK(times.at("p99").get<double>() == ofRank(0.99));
    CHECK(times.at("max").get<double>() == ofRank(1.0));
}

void checkSummaryKeys(const json& s) {
    checkKeys(s, kSummaryKeys);
    checkKeys(s.at("frames"), kFramesKeys);
    checkTimes(s.at("frames").at("latency_ms"), kTimesKeys, s.at("frames").at("count") > 0);
    checkKeys(s.at("haptic"), kHapticKeys);
    checkTimes(s.at("haptic").at("turn_us"), kTickTimesKeys, s.at("haptic").at("ticks") > 0);
    checkKeys(s.at("haptic").at("solver"), kSolverKeys);
    checkKeys(s.at("contact"), kContactKeys);
    checkTimes(s.at("contact").at("query_us"), kTimesKeys, s.at("haptic").at("ticks") > 0);
    for (const json& row : s.at("fixtures")) {
        checkKeys(row, kFixtureKeys);
    }
    for (const json& row : s.at("guidance")) {
        checkKeys(row, kGuidanceKeys);
    }
    const std::string where = s.at("contact").at("where"), digest = s.at("digest");
    CHECK((where == "cpu" || where == "gpu" || where == "none"));
    CHECK(s.at("lockstep") == true);
    CHECK(!s.at("device").get<std::string>().empty());
    CHECK(digest.size() >= 16);
    CHECK(digest.find_first_not_of("0123456789abcdef") == std::string::npos);
}

void checkFiles(const Replay& replay) {
    for (const char* name : {"traces.png", "overlay.png"}) {
        const ReadImage image = readImage(replay.out / name);
        CHECK(image.width >= 64);
        CHECK(image.height >= 48);
        CHECK(std::set<uint32_t>(image.pixels.begin(), image.pixels.end()).size() > 8);
    }
    for (const auto& entry : fs::directory_iterator(replay.out)) {
        CHECK(entry.path().extension() != ".partial");
    }
}

// Totals over the rows.
struct Sums {
    size_t stalled = 0, trapped = 0, escape = 0, waiting = 0;
    double force = 0.0, torque = 0.0, step = 0.0;

    void add(const Tick& tick, const dvec3& forceBefore) {
        stalled += tick.stalled;
        trapped += tick.state == "trapped";
        escape += tick.state == "escape";
        waiting += tick.state == "waiting";
        force = std::max(force, glm::length(tick.force));
        torque = std::max(torque, glm::length(tick.torque));
        step = std::max(step, glm::length(tick.force - forceBefore));
    }
};

Sums checkRows(const Replay& replay, const Terms& terms, double allowance) {
    Sums sums;
    std::string fault;
    size_t faults = 0, at = 0;
    bool touched = false;
    dvec3 before(0.0);
    int frame = -1;
    CauseCheck causes;
    for (size_t i = 0; i < replay.ticks.size(); ++i) {
        const Tick& tick = replay.ticks[i];
        std::string why = faultOf(tick, terms, allowance);
        touched = touched || tick.contacts > 0 || tick.stalled > 0 || tick.guidance > 0.0 ||
                  tick.state == "escape" || tick.state == "trapped";
        if (terms.calm && !touched && (glm::length(tick.force) > 1e-9 || glm::length(tick.torque) > 1e-9)) {
            why = "a wrench before any contact";
        } else if (std::abs(tick.t - static_cast<double>(i) / terms.rate) > 1e-9) {
            why = "t_s is not i / rate";
        } else if (tick.frame < frame) {
            why = "an older frame comes into force";
        }
        const std::string wrong = causes.add(tick, terms);
        why = why.empty() ? wrong : why;
        if (!why.empty() && faults++ == 0) {
            fault = why, at = i;
        }
        frame = tick.frame;
        sums.add(tick, before);
        before = tick.force;
    }
    CHECK_MESSAGE(faults == 0, "row ", at, ": ", fault);
    return sums;
}

void checkTicks(const Replay& replay, const Terms& terms) {
    const json& haptic = replay.haptic();
    REQUIRE(!replay.ticks.empty());
    CHECK(haptic.at("ticks") == replay.ticks.size());
    const double penetration = haptic.at("max_penetration_m"), depth = haptic.at("max_escape_depth_m");
    const Sums sums = checkRows(replay, terms, depth + penetration + 1e-9);
    CHECK(haptic.at("stalled_ticks") == sums.stalled);
    CHECK(haptic.at("trapped_ticks") == sums.trapped);
    CHECK(haptic.at("escape_ticks") == sums.escape);
    CHECK(haptic.at("waiting_ticks") == sums.waiting);
    CHECK(haptic.at("not_finite_ticks") == 0);
    CHECK(haptic.at("max_force_N").get<double>() == doctest::Approx(sums.force).epsilon(1e-12));
    CHECK(haptic.at("max_torque_Nm").get<double>() == doctest::Approx(sums.torque).epsilon(1e-12));
    CHECK(haptic.at("max_force_step_N").get<double>() == doctest::Approx(sums.step).epsilon(1e-12));
    CHECK(penetration <= 1e-5);
}

// Passes have times exactly when the frame makes a set; upload, passes and publication fit the latency.
void checkFrameTimes(const Replay& replay) {
    std::vector<double> upload, passes, answerable;
    double longest = 0.0;
    for (const FrameRow& row : replay.frames) {
        CAPTURE(row.index);
        const double publish = row.times.at("publish_ms");
        upload.push_back(row.times.at("upload_ms")), passes.push_back(0.0);
        for (const auto& [column, time] : row.times) {
            const std::string name = column; // clang 14 captures no part of a structured binding
            CAPTURE(name);
            if (column != "upload_ms" && column != "publish_ms") {
                CHECK((time > 0.0) == (publish > 0.0));
                passes.back() += column == "answerable_ms" ? 0.0 : time;
            }
        }
        longest = std::max(longest, upload.back() + passes.back() + publish);
        answerable.insert(answerable.end(), publish > 0.0 ? 1 : 0, row.times.at("answerable_ms"));
    }
    checkColumn(replay.summary.at("frames").at("upload_ms"), upload);
    checkColumn(replay.summary.at("frames").at("gpu_ms"), passes);
    checkColumn(replay.summary.at("frames").at("answerable_ms"), answerable);
    CHECK(longest * (1.0 - 1e-6) <= replay.summary.at("frames").at("latency_ms").at("max").get<double>());
}

void checkFrames(const Replay& replay) {
    const json& summary = replay.summary;
    CHECK(summary.at("frames").at("count") == replay.frames.size());
    std::set<int> used;
    double forbidden = 0.0, guidance = 0.0, spheres = 0.0;
    for (const FrameRow& row : replay.frames) {
        CAPTURE(row.index);
        CHECK(std::abs(row.t - row.index / 30.0) < 1e-9);
        CHECK((used.empty() || static_cast<int>(row.index) > *used.rbegin()));
        used.insert(static_cast<int>(row.index));
        CHECK((row.spheres > 0) == (row.patches > 0));
        CHECK(row.patches <= row.spheres);
        CHECK((row.spheres == 0 || row.nodes > row.patches));
        CHECK(row.forbidden <= row.valid);
        CHECK(row.guidance <= row.valid);
        forbidden += static_cast<double>(row.forbidden);
        guidance += static_cast<double>(row.guidance);
        spheres += static_cast<double>(row.spheres);
        const fs::path file = replay.ply(static_cast<int>(row.index));
        if (fs::exists(replay.out / "fixtures")) {
            const std::vector<SavedSphere> saved = readPly(file);
            CHECK(saved.size() == row.spheres);
            const auto seen =
                std::count_if(saved.begin(), saved.end(), [](const SavedSphere& s) { return s.held == 0; });
            CHECK(static_cast<uint64_t>(seen) <= row.forbidden);
        }
    }
    for (const Tick& tick : replay.ticks) {
        CHECK((tick.frame == -1 || used.count(tick.frame) == 1));
    }
    // A pixel may be in several classes, so their sum is at least the number of marked pixels.
    double classPoints = 0.0, classSpheres = 0.0;
    for (const json& row : summary.at("fixtures")) {
        classPoints += row.at("points_mean").is_null() ? 0.0 : row.at("points_mean").get<double>();
        classSpheres += row.at("spheres_mean").is_null() ? 0.0 : row.at("spheres_mean").get<double>();
    }
    const double n = static_cast<double>(std::max<size_t>(1, replay.frames.size()));
    CHECK(classPoints >= std::max(forbidden, guidance) / n - 1e-6);
    CHECK(classSpheres == doctest::Approx(spheres / n));
}

} // namespace

fs::path Replay::ply(int frame) const {
    const std::string digits = std::to_string(frame);
    return out / "fixtures" / (std::string(6 - digits.size(), '0') + digits + ".ply");
}

const Tick& Replay::at(double t) const {
    return *std::find_if(ticks.begin(), ticks.end() - 1,
                         [t](const Tick& tick) { return tick.t >= t - 1e-9; });
}

Replay readReplay(const fs::path& out, const ProgramRun& run) {
    Replay replay{out, run, {}, {}, {}, {}};
    replay.summary = json::parse(readWhole(out / "summary.json"));
    replay.ticks = readTicks(out / "haptics.csv");
    replay.frames = readFrames(out / "frames.csv", &replay.timeColumns);
    return replay;
}

void checkContract(const Replay& replay, const Terms& terms) {
    checkSummaryKeys(replay.summary);
    checkFiles(replay);
    checkTicks(replay, terms);
    checkFrames(replay);
    checkFrameTimes(replay);
}

Stage::Stage() {
    scene(SceneText{});
}

std::vector<std::string> Stage::command(const std::vector<std::string>& more, const std::string& out) const {
    std::vector<std::string> words{"replay", (*this / "scene.yaml").string(), "--out",
                                   (*this / out).string()};
    if (fs::exists(*this / "rec")) {
        words.insert(words.end(), {"--source", (*this / "rec").string()});
    }
    if (fs::exists(*this / "hand.csv")) {
        words.insert(words.end(), {"--operator", (*this / "hand.csv").string()});
    }
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

Replay Stage::replay(const std::vector<std::string>& more, const Terms& terms, const std::string& out) const {
    const ProgramRun run = runFathom(command(more, out));
    const std::string warning = terms.empty.empty() ? terms.warning : "fixture '" + terms.empty + "' has no ";
    if (warning.empty()) {
        CHECK(run.err == "");
    } else {
        REQUIRE(run.errorLines().size() == 1);
        CHECK(run.err.starts_with("warning: " + warning));
    }
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    const Replay replay = readReplay(*this / out, run);
    checkContract(replay, terms);
    return replay;
}

} // namespace fathom
