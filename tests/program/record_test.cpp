// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/stage.h"
#include "tests/support/eventually.h"

#include <algorithm>
#include <csignal>
#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("A recording that is ended by SIGINT is complete: every frame of its index is replayed") {
    const Stage stage;
    const std::string scene = "apps/scenes/demo.yaml", folder = (stage / "pictures").string();
    const pid_t engine = startFathom({"record", scene, "--out", folder}, stage / "said");
    CHECK(testing::eventually([&] { return std::filesystem::exists(stage / "pictures/depth/000003.png"); }));
    CHECK(exitCodeOf(engine, SIGINT) == 0);
    std::string index = stage.read("pictures/associations.txt");
    REQUIRE_FALSE(index.empty());
    CHECK(index.back() == '\n');
    const auto lines = std::count(index.begin(), index.end(), '\n');
    CHECK(lines >= 3);
    CHECK(lines < 60); // it was interrupted: the simulated camera has more frames
    const std::string said = "recorded     " + std::to_string(lines) + " frames";
    CHECK_MESSAGE(stage.read("said").find(said) != std::string::npos, stage.read("said"));
    const ProgramRun run =
        runFathom({"replay", scene, "--source", folder, "--out", (stage / "out").string()});
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.err == "");
    const Replay replay = readReplay(stage / "out", run);
    CHECK(replay.summary.at("frames").at("count") == lines);
    CHECK(replay.summary.at("frames").at("skipped") == 0);
}
