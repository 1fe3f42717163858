// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/summary.h"

#include "apps/output/progress.h"
#include "apps/replay/tick_totals.h"
#include "tests/rig/summary_keys.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

using namespace fathom;
using namespace fathom::testing;
using Ordered = nlohmann::ordered_json;

namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

Keys keysOf(const Ordered& object) {
    Keys keys;
    for (const auto& item : object.items()) {
        keys.push_back(item.key());
    }
    return keys;
}

} // namespace

TEST_CASE("Percentiles are the values of nearest rank for 0, 1, 2, 99, 100, 101 and 1000 values") {
    CHECK(!percentilesOf({}).p50);
    CHECK(!percentilesOf({std::numeric_limits<float>::quiet_NaN()}).max);
    std::mt19937 random(3);
    for (const int count : {1, 2, 99, 100, 101, 1000, 1237}) {
        std::vector<float> values;
        for (int i = 1; i <= count; ++i) {
            values.push_back(static_cast<float>(i));
        }
        std::shuffle(values.begin(), values.end(), random);
        values.push_back(std::numeric_limits<float>::infinity()); // ignored
        const Percentiles p = percentilesOf(values);
        // Value i has rank i, so the percentile is the rank, in whole numbers.
        CHECK(*p.p50 == (count + 1) / 2);
        CHECK(*p.p99 == (99 * count + 99) / 100);
        CHECK(*p.p999 == (999 * count + 999) / 1000);
        CHECK(*p.max == count);
    }
    CHECK(*percentilesOf({12.3f}).p50 == 12.3);
}

TEST_CASE("summary.json has the documented keys in their order") {
    ReplaySummary summary;
    summary.fixtures.push_back({"wheel", "forbidden", 10.0, 5.0, 1.0});
    summary.guidance.push_back(
        {"body", dvec3(1, 2, 3), dvec3(0, 0, -1), Pose{{4, 5, 6}, {0.5, 0.5, -0.5, 0.5}}, 77});
    const Ordered json = Ordered::parse(toJson(summary));
    CHECK(keysOf(json) == kSummaryKeys);
    CHECK(keysOf(json["frames"]) == kFramesKeys);
    CHECK(keysOf(json["frames"]["gpu_ms"]) == kTimesKeys);
    CHECK(keysOf(json["haptic"]) == kHapticKeys);
    CHECK(keysOf(json["haptic"]["turn_us"]) == kTickTimesKeys);
    CHECK(keysOf(json["haptic"]["solver"]) == kSolverKeys);
    CHECK(keysOf(json["contact"]) == kContactKeys);
    CHECK(keysOf(json["fixtures"][0]) == kFixtureKeys);
    CHECK(keysOf(json["guidance"][0]) == kGuidanceKeys);
    CHECK(json["guidance"][0]["target_qwxyz"] == Ordered::array({0.5, 0.5, -0.5, 0.5}));
    CHECK(json["guidance"][0]["position_m"] == Ordered::array({1.0, 2.0, 3.0}));
    CHECK(json["contact"]["where"] == "none");
}

TEST_CASE("Unknown and non-finite values are null, and bytes that are not UTF-8 do not damage the file") {
    const ScratchFolder folder;
    ReplaySummary summary;
    summary.haptic.maxPenetration = kNan;
    summary.haptic.maxForce = std::numeric_limits<double>::infinity();
    summary.haptic.marginPassiveMin = 0.1;
    summary.guidance.push_back({"body", std::nullopt, dvec3(kNan), std::nullopt, 0});
    summary.device = "bad \xff\xfe name";
    put(folder.path() / "summary.json", toJson(summary));
    const std::string text = textOf(folder.path() / "summary.json");
    const Ordered json = Ordered::parse(text);
    CHECK(json["haptic"]["max_penetration_m"].is_null());
    CHECK(json["haptic"]["max_escape_depth_m"].is_null());
    CHECK(json["haptic"]["max_force_N"].is_null());
    CHECK(json["haptic"]["turn_us"]["p999"].is_null());
    CHECK(json["haptic"]["margin_passive_min"] == 0.1);
    CHECK(json["guidance"][0]["position_m"].is_null());
    CHECK(json["guidance"][0]["normal"].is_null());
    CHECK(json["guidance"][0]["target_m"].is_null());
    CHECK(json["guidance"][0]["target_qwxyz"].is_null());
    CHECK(json["fixtures"].is_array());
    CHECK(json["fixtures"].empty());
    for (size_t at = text.find("inf"); at != std::string::npos; at = text.find("inf", at + 1)) {
        CHECK(text.substr(at, 10) == "infeasible");
    }
    CHECK(text.find("nan") == std::string::npos);
}

TEST_CASE(
    "Tick totals count, keep extremes, measure force steps from zero and ignore values that are not finite") {
    TickTotals totals;
    TickRow row;
    StepRecord& tick = row.record;
    tick.wrench.force = {3, 0, 4};
    tick.wrench.torque = {0, 0.5, 0};
    tick.state = StepState::Escape;
    tick.marginPassive = 0.4;
    tick.solves = 3;
    row.micros = 10.0;
    totals.add(row);
    tick.wrench.force = {3, 0, -2};
    tick.wrench.torque = {kNan, 0, 0};
    tick.state = StepState::Trapped;
    tick.marginPassive = 0.2;
    tick.stalled = true;
    tick.infeasible = 1;
    tick.finite = false;
    totals.add(row);
    tick.finite = true;
    tick.wrench.force = {kNan, 0, 0};
    tick.state = StepState::Free;
    tick.marginPassive = kNan;
    tick.solves = 0;
    row.late = true;
    totals.add(row);
    ReplaySummary::Haptic haptic;
    haptic.stiffness = 800.0;
    haptic.take(totals);
    CHECK(haptic.ticks == 3);
    CHECK(haptic.late == 1);
    CHECK(haptic.stalledTicks == 2);
    CHECK(haptic.trappedTicks == 1);
    CHECK(haptic.escapeTicks == 1);
    CHECK(haptic.maxForce == 5.0);
    CHECK(haptic.maxForceStep == 6.0);
    CHECK(haptic.maxTorque == 0.5);
    CHECK(*haptic.marginPassiveMin == 0.2);
    CHECK(!haptic.marginUncoupledMin);
    CHECK(*haptic.solvesMean == 2.0);
    CHECK(haptic.infeasible == 2);
    CHECK(haptic.notFiniteTicks == 1);
    CHECK(*haptic.stepMicros.max == 10.0);
    CHECK(*haptic.stiffness == 800.0);
    ReplaySummary::Haptic none;
    none.take(TickTotals{});
    CHECK(!none.solvesMean);
}

TEST_CASE("Progress writes nothing without a terminal, and on a terminal one line that it removes") {
    const ScratchFolder folder;
    for (const bool terminal : {false, true}) {
        const auto path = folder.path() / "out";
        std::FILE* file = std::fopen(path.c_str(), "w+");
        REQUIRE(file != nullptr);
        {
            Progress progress(file, terminal);
            for (uint64_t i = 0; i < 100000; ++i) {
                progress.update({i / 33, 60, static_cast<double>(i) / 1000.0});
            }
        }
        {
            Progress discovered(file); // a file is not a terminal
            discovered.update({1, 2, 4.0});
        }
        std::fclose(file);
        const std::string text = textOf(path);
        CHECK(text.empty() == !terminal);
        if (terminal) {
            CHECK(text.find("frame 0 of 60") != std::string::npos);
            CHECK(text.find('\n') == std::string::npos);
            CHECK(text.rfind("\r\x1b[K") == text.size() - 4);
            CHECK(text.size() < 4000); // ten updates per second, not a hundred thousand
        }
    }
    CHECK(progressText({12, 60, 4.2}, 3.0) == "frame 12 of 60, 12 s left, 4 frames/s, 1.40 x real time");
    // Time left by the run's clock, else by frames, and only after the first second.
    CHECK(progressText({12, 60, 4.2, 8.4}, 3.0).starts_with("frame 12 of 60, 3 s left, 4 frames/s"));
    CHECK(progressText({1000, 108000, 0.0, 0.0, true}, 10.0) ==
          "frame 1000 of 108000, 17 min 50 s left, 100 frames/s");
    CHECK(progressText({1000, 108000, 0.0, 0.0, true}, 100.0) ==
          "frame 1000 of 108000, 2 h 58 min left, 10 frames/s");
    CHECK(progressText({10, 108000, 0.0, 0.0, true}, 0.5) == "frame 10 of 108000, 20 frames/s");
    CHECK(progressText({10, 0, 0.0, 0.0, true}, 5.0) == "frame 10, 2 frames/s");
    CHECK(progressText({0, 0, 0.0}, 0.0) == "frame 0, 0 frames/s, 0.00 x real time");
}
