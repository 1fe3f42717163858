// SPDX-License-Identifier: Apache-2.0
// `fathom latency` on a small recording. Checks the counts only: wake-up times depend on the machine.
#include "tests/rig/stage.h"
#include "tests/support/eventually.h"

#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <thread>

using namespace fathom;

namespace {

// Runs latency on four repeated frames, with `more` options.
std::vector<std::string> latencyCommand(const Stage& stage, const std::vector<std::string>& more) {
    stage.recording(std::vector<Image>(4, bumpImage()));
    stage.scene({});
    std::vector<std::string> words{"latency",  (stage / "scene.yaml").string(),
                                   "--source", (stage / "rec").string(),
                                   "--device", "llvmpipe",
                                   "--out",    (stage / "latency.json").string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

nlohmann::json onlyPart(const Stage& stage) {
    const auto report = nlohmann::json::parse(stage.read("latency.json"));
    REQUIRE(report.at("parts").size() == 1);
    return report["parts"][0];
}

} // namespace

TEST_CASE("latency measures with and without frames, and accounts for every tick") {
    const Stage stage;
    const ProgramRun run =
        runFathom(latencyCommand(stage, {"--seconds", "0.7", "--load", "idle", "--load", "frames"}));
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    const auto report = nlohmann::json::parse(stage.read("latency.json"));
    CHECK(report.at("rate_hz") == 1000.0);
    REQUIRE(report.at("parts").size() == 2);
    for (const auto& part : report.at("parts")) {
        CHECK(part.at("seconds").get<double>() >= 0.69);
        const auto ticks = part.at("turn").at("count").get<uint64_t>();
        CHECK(ticks > 5);
        CHECK(part.at("woken_late").at("count") == ticks);
        // Every period is a tick or is counted as missed: 0.7 s, plus the time until the writer ends the run.
        CHECK(ticks + part.at("periods_missed").get<uint64_t>() >= 690);
        CHECK(part.at("records_lost") == 0);
    }
    CHECK(report["parts"][0].at("load") == "idle");
    CHECK(report["parts"][0].at("frames_lost") == 0);
    CHECK(run.out.find("frames late") != std::string::npos);
}

TEST_CASE("latency measures with a window, which draws offscreen without a display") {
    ::unsetenv("DISPLAY");
    const Stage stage;
    const ProgramRun run = runFathom(latencyCommand(stage, {"--seconds", "0.7", "--load", "window"}));
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    const auto part = onlyPart(stage);
    CHECK(part.at("load") == "window");
    CHECK(part.at("seconds").get<double>() >= 0.7); // even when ticks were late
    const auto ticks = part.at("turn").at("count").get<uint64_t>();
    CHECK(ticks > 5);
    CHECK(part.at("woken_late").at("count") == ticks);
    CHECK(ticks + part.at("periods_missed").get<uint64_t>() >= 690);
    CHECK(run.out.find("window step") != std::string::npos);
}

TEST_CASE("A soak test exits with code 0 when it meets its limits, and with 1 when it misses one") {
    const Stage stage;
    const ProgramRun run = runFathom(latencyCommand(stage, {"--soak", "0.02"}));
    CAPTURE(run.err);
    const auto part = onlyPart(stage);
    CHECK(part.at("load") == "frames");
    CHECK(part.at("seconds").get<double>() >= 1.19);
    CHECK(part.at("memory_MiB").size() >= 20);
    const bool holds = part.at("frames_lost") == 0 && part.at("records_lost") == 0 &&
                       part.at("memory_growth_MiB").get<double>() <= 8.0;
    CHECK(run.exitCode == (holds ? 0 : 1));
    CHECK(run.out.find(holds ? "soak         kept: asked are 1.2 s" : "MISSED") != std::string::npos);
}

TEST_CASE("A soak test that is interrupted exits with code 1") {
    const Stage stage;
    const pid_t child = startFathom(latencyCommand(stage, {"--soak", "60"}), stage / "said");
    std::this_thread::sleep_for(std::chrono::seconds(2));
    const int exitCode = exitCodeOf(child, SIGINT);
    const std::string said = stage.read("said");
    CAPTURE(said);
    CHECK(exitCode == 1);
    CHECK(said.find("soak         MISSED: asked are 3600.0 s") != std::string::npos);
}

TEST_CASE(
    "A latency run that is ended by SIGINT reports its parts and a warning; without any, the old report "
    "stays") {
    const Stage stage;
    const auto words = latencyCommand(stage, {"--seconds", "4", "--load", "idle", "--load", "frames"});
    const auto said = [&](const char* text) { return stage.read("said").find(text) != std::string::npos; };
    stage.write("latency.json", "old");
    pid_t child = startFathom(words, stage / "said");
    CHECK(testing::eventually([&] { return handlesInterrupt(child); })); // before its first part
    CHECK(exitCodeOf(child, SIGINT) == 1);
    CHECK(said("latency: ended by a signal, 0 of 2 parts are whole: no report"));
    CHECK(stage.read("latency.json") == "old");

    child = startFathom(words, stage / "said");
    CHECK(testing::eventually([&] { return said("idle         woken late"); }));
    CHECK(exitCodeOf(child, SIGINT) == 0);
    CHECK(said("ended by a signal, 1 of 2 parts are whole"));
    const auto report = nlohmann::json::parse(stage.read("latency.json"));
    CHECK(report.at("ended_by_signal") == true);
    CHECK(report.at("parts").at(0).at("seconds").get<double>() >= 3.9);
}

TEST_CASE("latency rejects an unknown load and an invalid length in one line") {
    for (const char* bad : {"--load=party", "--seconds=0", "--soak=-1"}) {
        const ProgramRun run = runFathom({"latency", "apps/scenes/demo.yaml", bad});
        CHECK(run.exitCode == 2);
        CHECK(run.errorLines().size() == 1);
    }
}
