// SPDX-License-Identifier: Apache-2.0
// The GPU is lost while the program runs (a Vulkan layer simulates it): the haptic thread continues with the
// last set, the device is opened again, and frames resume.
#include "tests/rig/cause_check.h"
#include "tests/rig/losing.h"
#include "tests/rig/stage.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <map>
#include <set>

using namespace fathom;

namespace {

// [s] The run ends then, whether or not the GPU is back. A slow machine opens it again in 3 s.
constexpr double kEnd = 8.0;

// 4 s of frames, and a hand that presses into the bump until the end.
void setPressing(const Stage& stage, const std::string& where = "cpu") {
    stage.recording(std::vector<Image>(120, bumpImage()));
    SceneText scene;
    scene.contact = "where: " + where;
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.5, {0.0, 0.0, 0.52}}, {kEnd, {0.0, 0.0, 0.52}}});
}

double deepest(const Replay& replay) {
    return replay.haptic().at("max_penetration_m").get<double>();
}

// Every set that a tick obeys has a row in frames.csv.
void checkRecorded(const Replay& replay) {
    std::set<int64_t> recorded;
    for (const FrameRow& row : replay.frames) {
        recorded.insert(row.index);
    }
    for (const Tick& tick : replay.ticks) {
        CHECK((tick.frame < 0 || recorded.count(tick.frame) == 1));
    }
}

} // namespace

TEST_CASE("A GPU that is lost or out of memory is opened again while the hand continues, and frames resume") {
    for (const bool lost : {true, false}) {
        CAPTURE(lost);
        Stage stage;
        setPressing(stage, lost ? "gpu" : "cpu"); // device of the contact query
        const Losing losing(lost ? 400 : 30, lost ? "lost" : "memory", 2);
        const ProgramRun run = runFathom(stage.command({"--realtime", "--device", "llvmpipe"}));
        CAPTURE(run.err);
        REQUIRE(run.exitCode == 0);
        CHECK(run.err.find("GPU is ") != std::string::npos);
        CHECK(run.err.find("GPU is back") != std::string::npos);
        CHECK(run.out.find("lost and reopened 1 times") != std::string::npos);
        const Replay replay = readReplay(stage / "out", run);
        checkForces(replay.ticks, {}, 1e-5, true);
        CHECK(deepest(replay) <= 1e-5);
        REQUIRE(!replay.frames.empty());
        CHECK(replay.frames.back().index == 119); // up to the last one
        CHECK(replay.frames.size() == 119);       // all except the one lost with the device
        CHECK(replay.frames.back().spheres == replay.frames.front().spheres);
        CHECK(replay.ticks.back().t > kEnd - 0.1);
    }
}

TEST_CASE(
    "A GPU that is lost once a set's passes have completed leaves the CPU the host's copies, and every set "
    "that a tick obeys is recorded") {
    Stage stage;
    setPressing(stage, "gpu");
    const Losing losing(40, "lost", 2, "DONE");
    const ProgramRun run = runFathom(stage.command({"--realtime", "--device", "llvmpipe"}));
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    CHECK(run.err.find("the CPU answers") != std::string::npos);
    CHECK(run.out.find("lost and reopened 1 times") != std::string::npos);
    const Replay replay = readReplay(stage / "out", run);
    checkForces(replay.ticks, {}, 1e-5, true);
    CHECK(deepest(replay) <= 1e-5);
    checkRecorded(replay);
    CHECK(replay.frames.size() == 119); // all except the one after the loss
    CHECK(replay.frames.back().spheres == replay.frames.front().spheres);
    CHECK(replay.ticks.back().t > kEnd - 0.1);
}

TEST_CASE(
    "A GPU that is lost after a frame's set is published leaves no tick with a set that frames.csv lacks") {
    Stage stage;
    setPressing(stage);
    const Losing losing(30, "lost", 0, "TIMES");
    const ProgramRun run = runFathom(stage.command({"--realtime", "--device", "llvmpipe"}));
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    CHECK(run.out.find("lost and reopened 1 times") != std::string::npos);
    const Replay replay = readReplay(stage / "out", run);
    checkForces(replay.ticks, {}, 1e-5, true);
    CHECK(deepest(replay) <= 1e-5);
    checkRecorded(replay);
    CHECK(replay.ticks.back().t > kEnd - 0.1);
}

TEST_CASE("A GPU that never comes back leaves the hand without force, outside the last regions, until its "
          "path ends") {
    Stage stage;
    setPressing(stage);
    const Losing losing(30, "lost", 1000000);
    const ProgramRun run = runFathom(stage.command({"--realtime", "--device", "llvmpipe"}));
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    const Replay replay = readReplay(stage / "out", run);
    checkForces(replay.ticks, {}, 1e-5, true);
    CHECK(deepest(replay) <= 1e-5);
    CHECK(replay.frames.back().index < 30);
    CHECK(replay.ticks.back().t > kEnd - 0.1);
    CHECK(glm::length(replay.ticks.back().force) == 0.0); // faded out
    const bool touched = std::any_of(replay.ticks.begin(), replay.ticks.end(),
                                     [](const Tick& tick) { return glm::length(tick.force) > 1.0; });
    CHECK(touched);
    CHECK(run.out.find("made anew") == std::string::npos);
}

TEST_CASE("In lockstep a lost GPU ends the run with exit code 3 and one line, and leaves the old results "
          "unchanged") {
    Stage stage;
    setPressing(stage);
    REQUIRE(runFathom(stage.command({"--device", "llvmpipe"})).exitCode == 0);
    const auto results = [&] {
        std::map<std::string, std::string> files;
        for (const auto& file : std::filesystem::directory_iterator(stage / "out")) {
            files[file.path().filename()] = readWhole(file.path());
        }
        return files;
    };
    const auto before = results();
    CHECK(before.count("summary.json") == 1);
    const Losing losing(30, "lost", 0);
    const ProgramRun run = runFathom(stage.command({"--device", "llvmpipe"}));
    CHECK(run.exitCode == 3);
    CHECK(run.errorLines().size() == 1);
    CHECK((results() == before));
}
