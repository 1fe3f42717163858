// SPDX-License-Identifier: Apache-2.0
// The rules of lockstep: when frames and contact answers become active, what each step waits for, when a run
// ends.
#include "tests/rig/stage.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;

namespace {

// `count` frames, all different.
std::vector<Image> lockstepFrames(uint32_t count) {
    std::vector<Image> all;
    for (uint32_t i = 0; i < count; ++i) {
        all.push_back(bumpImage().paint({i, 40, i + 2, 42}, kRed));
    }
    return all;
}

// The first tick that uses the set of a frame.
size_t firstTick(const Replay& replay, int frame) {
    for (size_t i = 0; i < replay.ticks.size(); ++i) {
        if (replay.ticks[i].frame == frame) {
            return i;
        }
    }
    return SIZE_MAX;
}

size_t dueTick(int frame, double rate) { // first i with i / rate >= frame / 30
    return static_cast<size_t>(std::ceil(frame / 30.0 * rate - 1e-6));
}

} // namespace

TEST_CASE("Frame j is active from the first tick at or after j / 30 s, at any rate") {
    for (const double rate : {1000.0, 730.0, 120.0, 4000.0}) {
        CAPTURE(rate);
        Stage stage;
        stage.recording(lockstepFrames(5));
        SceneText scene;
        scene.haptics = "rate_hz: " + std::to_string(rate);
        stage.scene(scene);
        stage.hand({{0.0, {0.0, 0.0, 0.4}}});
        const Replay replay = stage.replay({}, {rate});
        // Frames 0 to 4 and 1/30 s after the last: the run ends at 5/30 s.
        CHECK(replay.ticks.size() == dueTick(5, rate));
        for (int j = 0; j < 5; ++j) {
            CHECK(firstTick(replay, j) == dueTick(j, rate));
        }
        CHECK(replay.ticks.front().state == "free");
    }
}

TEST_CASE("Lockstep ignores stamps: frames an hour apart run as at 30 Hz") {
    Stage stage;
    stage.recording(lockstepFrames(3));
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const Replay plain = stage.replay({}, {}, "a");
    stage.write("rec/associations.txt",
                "0 rgb/000000.png 5 depth/000000.png\n3600 rgb/000001.png 3600 depth/000001.png\n"
                "9000 rgb/000002.png 9000.5 depth/000002.png\n");
    const Replay slow = stage.replay({}, {}, "b");
    CHECK(plain.summary.at("digest") == slow.summary.at("digest"));
    CHECK(slow.ticks.size() == 100);
}

TEST_CASE(
    "A recording whose rate is far from 30 Hz has one line in the log, which states the change of speed") {
    Stage stage;
    stage.recording(lockstepFrames(6));
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const auto logged = [&](double rate) {
        std::string index;
        for (int i = 0; i < 6; ++i) {
            const std::string stamp = std::to_string(i / rate), name = std::to_string(i) + ".png ";
            index += stamp + " rgb/00000" + name + stamp + " depth/00000" + name + "\n";
        }
        stage.write("rec/associations.txt", index);
        const ProgramRun run = runFathom(stage.command({"--strict"}));
        CHECK_MESSAGE(run.exitCode == 0, run.err);
        return run.err;
    };
    CHECK(logged(30.0) == "");
    CHECK(logged(20.0) == "");
    CHECK(logged(45.0) == "");
    CHECK(logged(1.0) == ""); // stills
    CHECK(logged(15.0).find("the recording has 15 frames per second and is played at 30: speeds in it are 2 "
                            "times those recorded\n") != std::string::npos);
    CHECK(logged(90.0).find("has 90 frames per second and is played at 30: speeds in it are 0.333 times") !=
          std::string::npos);
}

TEST_CASE("contact.delay delays an answer by as many ticks, and the active set and its age with it") {
    Stage stage;
    stage.recording(lockstepFrames(4));
    SceneText scene;
    scene.contact = "delay: 7";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const Replay replay = stage.replay();
    for (int j = 0; j < 4; ++j) {
        CHECK(firstTick(replay, j) == dueTick(j, 1000.0) + 7);
    }
    for (size_t i = 0; i < 7; ++i) { // no answer yet: held, state off
        CHECK(replay.ticks[i].state == "off");
        CHECK(replay.ticks[i].frame == -1);
        CHECK(std::isnan(replay.ticks[i].minGap));
        CHECK(glm::length(replay.ticks[i].force) == 0.0);
    }
    // Just before the answer over frame 2, the active set is that of frame 1, captured at 1/30 s.
    const Tick& tick = replay.ticks[dueTick(2, 1000.0) + 6];
    CHECK(tick.frame == 1);
    CHECK(tick.sceneAge == doctest::Approx(tick.t - 1.0 / 30.0));
}

TEST_CASE("When the frames end first, the last one stays active, does not age and adds no row") {
    Stage stage;
    stage.recording(lockstepFrames(3));
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.7, {0.0, 0.0, 0.41}}});
    const Replay replay = stage.replay();
    CHECK(replay.ticks.size() == 700);
    CHECK(replay.frames.size() == 3);
    for (const Tick& tick : replay.ticks) {
        if (tick.t > 2.0 / 30.0) {
            CHECK(tick.frame == 2);
            CHECK(tick.sceneAge < 1.0 / 30.0);
            CHECK(tick.state == "free"); // no fading, because the source has ended
        } else {
            CHECK(tick.sceneAge == doctest::Approx(tick.t - std::floor(tick.t * 30.0 + 1e-9) / 30.0));
        }
    }
}

TEST_CASE("When the hand path ends first, it holds its last pose until the frames have ended") {
    Stage stage;
    stage.recording(lockstepFrames(9));
    stage.hand({{0.0, {0.0, 0.0, 0.40}}, {0.05, {0.01, 0.02, 0.42}, {0.8, 0.0, 0.6, 0.0}}});
    const Replay replay = stage.replay();
    CHECK(replay.ticks.size() == 300);
    const Tick& half = replay.at(0.025);
    CHECK(half.device.position.y == doctest::Approx(0.01)); // interpolated
    for (const Tick& tick : replay.ticks) {
        if (tick.t >= 0.05) {
            CHECK(glm::length(tick.device.position - dvec3(0.01, 0.02, 0.42)) < 1e-12);
            CHECK(std::abs(tick.device.rotation.w) == doctest::Approx(0.8));
        }
    }
}

TEST_CASE("A hand path from a file counts from the start of the run, also when the first frames are bad and "
          "nothing is seen yet") {
    Stage stage;
    stage.recording(lockstepFrames(4));
    stage.write("rec/depth/000000.png", "no frame");
    stage.write("rec/depth/000001.png", "no frame");
    stage.hand({{0.0, {0.0, 0.0, 0.40}}, {0.1, {0.0, 0.0, 0.41}}});
    const ProgramRun run = runFathom(stage.command());
    REQUIRE(run.exitCode == 0);
    const Replay replay = readReplay(stage / "out", run);
    checkContract(replay, {1000.0, 20.0, 2.0, false});
    CHECK(replay.at(0.05).device.position.z == doctest::Approx(0.405).epsilon(1e-9));
    CHECK(replay.ticks.front().frame == -1);
    CHECK(replay.ticks.front().state == "off");
    CHECK(firstTick(replay, 2) == dueTick(2, 1000.0));
    CHECK(firstTick(replay, 0) == SIZE_MAX);
    for (const Tick& tick : replay.ticks) {
        if (tick.frame < 0) {
            CHECK(glm::length(tick.force) == 0.0);
            CHECK(tick.tool.position == replay.ticks.front().tool.position); // held in place
        }
    }
}

TEST_CASE("The built-in path waits for the first set") {
    Stage stage;
    stage.recording(lockstepFrames(3));
    const Replay whole = stage.replay({}, {}, "a");
    stage.write("rec/depth/000000.png", "no frame");
    const ProgramRun run = runFathom(stage.command({}, "b"));
    REQUIRE(run.exitCode == 0);
    const Replay late = readReplay(stage / "b", run);
    CHECK(whole.ticks.size() >= 2000);
    CHECK(late.ticks.size() > whole.ticks.size() + 30); // 1/30 s later, about the same length
    CHECK(late.at(0.03).device.position == late.ticks.front().device.position);
}

TEST_CASE("poses.txt moves the camera, and the region with it") {
    Stage stage;
    stage.recording({bumpImage(), bumpImage(), bumpImage()});
    // 0.3 m/s along x, interpolated at the depth stamps 0, 1/30 and 2/30 s.
    stage.write("rec/poses.txt", "0 0 0 0 0 0 0 1\n1 0.3 0 0 0 0 0 1\n");
    stage.hand({{0.0, {0.0, 0.0, 0.3}}});
    SceneText scene;
    scene.more = "hold_s: 0\n";
    stage.scene(scene);
    const Replay replay = stage.replay({"--save-fixtures"});
    const std::vector<SavedSphere> first = readPly(replay.ply(0)), last = readPly(replay.ply(2));
    REQUIRE(first.size() == last.size());
    for (size_t i = 0; i < first.size(); ++i) {
        CHECK(glm::length(last[i].centre - first[i].centre - dvec3(0.02, 0.0, 0.0)) < 1e-6);
    }
}
