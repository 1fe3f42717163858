// SPDX-License-Identifier: Apache-2.0
// `fathom latency` on a small recording. How late a thread wakes is the machine's affair and no test's.
#include "tests/rig/stage.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("latency measures with and without frames, and tells of every turn") {
    Stage stage;
    stage.recording(std::vector<Picture>(4, bumpPicture()));
    stage.scene({});
    const std::string out = (stage / "latency.json").string();
    const ProgramRun run = runFathom({"latency", (stage / "scene.yaml").string(), "--source",
                                      (stage / "rec").string(), "--device", "llvmpipe", "--seconds", "0.7",
                                      "--load", "idle", "--load", "frames", "--out", out});
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    const auto report = nlohmann::json::parse(stage.read("latency.json"));
    CHECK(report.at("rate_hz") == 1000.0);
    REQUIRE(report.at("parts").size() == 2);
    for (const auto& part : report.at("parts")) {
        CHECK(part.at("seconds").get<double>() >= 0.69);
        const auto turns = part.at("turn").at("count").get<uint64_t>();
        CHECK(turns > 5);
        CHECK(part.at("woken_late").at("count") == turns);
        // Every period had a turn or is told of: 0.7 s and what passed until the writer asked it to end.
        CHECK(turns + part.at("periods_missed").get<uint64_t>() >= 690);
        CHECK(part.at("records_lost") == 0);
    }
    CHECK(report["parts"][0].at("load") == "idle");
    CHECK(report["parts"][0].at("frames_lost") == 0);
    CHECK(run.out.find("frames late") != std::string::npos);
}

TEST_CASE("latency refuses a load that it does not know and a length that is none, in one line") {
    for (const char* bad : {"--load=party", "--seconds=0", "--soak=-1"}) {
        const ProgramRun run = runFathom({"latency", "apps/scenes/demo.yaml", bad});
        CHECK(run.exitCode == 2);
        CHECK(run.errorLines().size() == 1);
    }
}
