// SPDX-License-Identifier: Apache-2.0
// Frame rates above and below 30 per second.
#include "tests/rig/program_refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr int kFrames = 24;

void prepare(const Stage& stage) {
    const PixelBox all{0, 0, kWidth, kHeight};
    std::vector<Image> images;
    for (int i = 0; i < kFrames; ++i) {
        images.push_back(Image(kWidth, kHeight, 600).paint(all, kRed));
    }
    stage.recording(images);
    stage.scene({});
    stage.hand({{0.0, {0.0, 0.0, 0.2}}, {0.1, {0.0, 0.0, 0.2}}}); // ends before the frames do
}

} // namespace

TEST_CASE("Frames come at the requested rate, and none before it is due") {
    for (const double rate : {90.0, 15.0}) {
        CAPTURE(rate);
        Stage stage;
        prepare(stage);
        const ProgramRun run = runFathom(stage.command(
            {"--realtime", rate > 30.0 ? "--frame-rate" : "--picture-rate", std::to_string(rate)}));
        INFO(run.err);
        REQUIRE(run.exitCode == 0);
        const Replay replay = readReplay(stage / "out", run);
        REQUIRE(replay.frames.size() == kFrames);
        for (const FrameRow& frame : replay.frames) {
            CHECK(frame.t >= frame.index / rate - 1e-6);
        }
        // Nearer to the requested rate than to 30 per second, also on a busy machine.
        const double half = 0.5 * (1.0 / rate + 1.0 / 30.0) * (kFrames - 1);
        CHECK((replay.frames.back().t < half) == (rate > 30.0));
        CHECK(replay.ticks.back().t >= replay.frames.back().t);
    }
}

TEST_CASE("A frame rate without --realtime, or one that no camera has, is rejected in one line") {
    Stage stage;
    prepare(stage);
    checkRefused(stage, {"together with --realtime"}, {"--frame-rate", "90"});
    checkRefused(stage, {"--frame-rate", "0"}, {"--realtime", "--frame-rate", "0"});
    checkRefused(stage, {"--frame-rate", "1000"}, {"--realtime", "--picture-rate", "1000"});
}
