// SPDX-License-Identifier: Apache-2.0
// Replays of a camera that sends its colour as YUYV.
#include "tests/rig/stage.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

// The frame of the valve, and a still hand.
void prepare(const Stage& stage, const std::string& colour) {
    SceneText scene;
    scene.camera = "source: {simulated: tank, pictures: 3, colour: " + colour + "}, near: 0.1, far: 3.0";
    scene.fixtures.push_back(SceneText::kGuideYellow);
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.2}}, {0.1, {0.0, 0.0, 0.2}}});
}

// Counts yellow pixels from the frame itself. The marks alone would also be visible on a grey image.
uint32_t yellowPixels(const std::filesystem::path& overlay) {
    const ReadImage image = readImage(overlay);
    return static_cast<uint32_t>(std::ranges::count_if(image.pixels, [](uint32_t p) {
        const uint32_t red = p & 255, green = p >> 8 & 255, blue = p >> 16 & 255;
        return red > blue + 60 && green > blue + 40;
    }));
}

} // namespace

TEST_CASE("A camera that sends YUYV gives the fixtures and the overlay of one that sends RGBA, in lockstep") {
    const Stage plainStage, packedStage;
    prepare(plainStage, "rgba"), prepare(packedStage, "yuyv");
    const Terms terms{.calm = false};
    const Replay plain = plainStage.replay({}, terms), packed = packedStage.replay({}, terms);
    REQUIRE(plain.frames.size() == packed.frames.size());
    for (size_t i = 0; i < plain.frames.size(); ++i) {
        const FrameRow &a = plain.frames[i], &b = packed.frames[i];
        CHECK(a.valid == b.valid);
        CHECK(a.forbidden > 1000);
        // Two pixels share their chroma, which is also rounded, so pixels near gates and edges change sides.
        const auto forbidden = static_cast<double>(a.forbidden), guidance = static_cast<double>(a.guidance);
        CHECK(static_cast<double>(b.forbidden) == doctest::Approx(forbidden).epsilon(0.05));
        CHECK(static_cast<double>(b.guidance) == doctest::Approx(guidance).epsilon(0.15));
        CHECK(a.forbidden != b.forbidden); // the colours did go through YUYV
    }
    const uint32_t yellow = yellowPixels(plain.out / "overlay.png");
    CHECK(yellow > 100);
    CHECK(yellowPixels(packed.out / "overlay.png") == doctest::Approx(yellow).epsilon(0.2));
}

TEST_CASE("YUYV frames run in a realtime replay, and their colours reach its overlay") {
    const Stage stage;
    prepare(stage, "yuyv");
    const ProgramRun run = runFathom(stage.command({"--realtime"}));
    CAPTURE(run.err);
    REQUIRE(run.exitCode == 0);
    const auto frames = readFrames(stage / "out/frames.csv");
    REQUIRE(frames.size() >= 3);
    CHECK(frames.front().forbidden > 1000);
    CHECK(yellowPixels(stage / "out/overlay.png") > 100);
}
