// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/program_refusal.h"
#include "tests/rig/stage.h"
#include "tests/support/eventually.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
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

TEST_CASE("A record or convert that is refused or finds no frame leaves nothing, so it can be run again") {
    const Stage stage;
    stage.recording({bumpImage()});
    stage.scene({});
    const std::string scene = (stage / "scene.yaml").string(), rec = (stage / "rec").string(),
                      out = (stage / "new").string();
    const std::vector<std::string> record{"record", scene, "--source", rec, "--out", out},
        convert{"convert", rec, "--out", out};
    std::vector<std::string> withHand = record;
    withHand.insert(withHand.end(), {"--hand-device", "falcon"});
    checkRefusal(withHand, {"--hand-device", "a live camera"});
    CHECK_FALSE(std::filesystem::exists(out));
    std::filesystem::rename(stage / "rec/depth", stage / "depth");
    for (const auto& command : {record, convert}) {
        CHECK(runFathom(command).exitCode == 2);
        CHECK_FALSE(std::filesystem::exists(out));
    }
    std::filesystem::rename(stage / "depth", stage / "rec/depth");
    for (const auto& command : {record, convert}) {
        const ProgramRun run = runFathom(command);
        CHECK_MESSAGE(run.exitCode == 0, run.err);
        std::filesystem::remove_all(out);
    }
}

TEST_CASE("A lockstep replay and a conversion that are ended by SIGINT leave complete files and a warning") {
    const Stage stage;
    stage.recording({Image(640, 480, 600)});
    std::string index;
    for (int i = 0; i < 200; ++i) { // the same images under other names
        char name[16];
        std::snprintf(name, sizeof name, "%06d.png", i);
        for (const char* kind : {"depth", "rgb"}) {
            if (i > 0) {
                std::filesystem::create_hard_link(stage / "rec" / kind / "000000.png",
                                                  stage / "rec" / kind / name);
            }
        }
        const std::string t = std::to_string(i / 30.0);
        index += t + " rgb/" + name + " " + t + " depth/" + name + "\n";
    }
    stage.write("rec/associations.txt", index);
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.2}}, {3000.0, {0.0, 0.0, 0.2}}});

    pid_t program = startFathom(stage.command(), stage / "said");
    CHECK(testing::eventually([&] { return std::filesystem::exists(stage / "out/haptics.csv.partial"); }));
    CHECK(exitCodeOf(program, SIGINT) == 0);
    CHECK(stage.read("said").find("ended by a signal at ") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(stage / "out/.fathom.lock"));
    const Replay replay = readReplay(stage / "out", {});
    CHECK(replay.ticks.size() >= 1);
    CHECK(replay.summary.at("warnings").dump().find("ended by a signal at ") != std::string::npos);

    program = startFathom(
        {"convert", (stage / "rec").string(), "--out", (stage / "mcap").string(), "--format", "mcap"},
        stage / "converted");
    CHECK(
        testing::eventually([&] { return std::filesystem::exists(stage / "mcap/recording.mcap.partial"); }));
    CHECK(exitCodeOf(program, SIGINT) == 0);
    CHECK(stage.read("converted").find("ended by a signal after ") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(stage / "mcap/.fathom.lock"));
    CHECK(runFathom({"inspect", (stage / "mcap/recording.mcap").string()}).exitCode == 0);
}
