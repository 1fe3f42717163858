// SPDX-License-Identifier: Apache-2.0
// Frames that come faster or slower than 30 a second.
#include "tests/rig/refusal.h"

#include <algorithm>
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
    stage.hand({{0.0, {0.0, 0.0, 0.2}}, {0.1, {0.0, 0.0, 0.2}}}); // shorter than the frames last
}

} // namespace

TEST_CASE("Frames come as many a second as are asked for, each no earlier than it is due") {
    for (const double rate : {90.0, 15.0}) {
        CAPTURE(rate);
        Stage stage;
        prepare(stage);
        const ProgramRun run =
            runFathom(stage.command({"--realtime", "--picture-rate", std::to_string(rate)}));
        INFO(run.err);
        REQUIRE(run.exitCode == 0);
        const Replay replay = readReplay(stage / "out", run);
        REQUIRE(replay.frames.size() == kFrames);
        for (const FrameRow& frame : replay.frames) {
            CHECK(frame.t >= frame.index / rate - 1e-6);
        }
        // However busy the machine is: not at 30 a second.
        const double half = 0.5 * (1.0 / rate + 1.0 / 30.0) * (kFrames - 1);
        CHECK((replay.frames.back().t < half) == (rate > 30.0));
        CHECK(replay.ticks.back().t >= replay.frames.back().t);
    }
}

TEST_CASE("A rate of frames without a clock, or none that a camera has, is refused in one line") {
    Stage stage;
    prepare(stage);
    checkRefused(stage, {"together with --realtime"}, {"--picture-rate", "90"});
    checkRefused(stage, {"--picture-rate", "0"}, {"--realtime", "--picture-rate", "0"});
    checkRefused(stage, {"--picture-rate", "1000"}, {"--realtime", "--picture-rate", "1000"});
}
