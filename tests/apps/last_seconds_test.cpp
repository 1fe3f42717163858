// SPDX-License-Identifier: Apache-2.0
// The last seconds of a run: what is kept, in how much memory, and that storing them gives the same
// recording.
#include "apps/operate/last_seconds.h"

#include "apps/operate/packed_image.h"
#include "apps/operate/recorder.h"
#include "tests/apps/viewed_run.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <fstream>
#include <sstream>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

constexpr uint32_t kAcross = 32, kDown = 24;

CameraInfo colourCamera() {
    CameraInfo camera;
    camera.depth = {kAcross, kDown, 30.0, 30.0, 15.5, 11.5};
    camera.colour = camera.depth;
    camera.metresPerUnit = 0.001;
    camera.hasColour = true;
    return camera;
}

// Frames at 30 Hz of noise over a grey area, each with ticks.
class NoisyRun {
public:
    explicit NoisyRun(RunSink& sink, double start = 0.0)
        : sink_(sink)
        , start_(start) {}

    void image(uint64_t edit = 0) {
        PublishedFrame frame;
        frame.t = start_ + static_cast<double>(frames_) / 30.0;
        frame.report.index = frames_++;
        frame.edit = edit;
        HostFixtures set;
        for (size_t i = 0; i < size_t{kAcross} * kDown; ++i) {
            noise_ = noise_ * 1664525u + 1013904223u;
            set.depth.push_back(static_cast<uint16_t>(i % 7 == 0 ? noise_ >> 16 : 600 + (noise_ >> 29)));
            frame.colour.push_back(i < 200 ? 0xff808080u : 0xff000000u | noise_ >> 8);
        }
        sink_.frame(frame, set);
        for (int k = 0; k < 5; ++k) {
            TickRow row;
            row.record.t = frame.t + 0.006 * k;
            row.record.wrench.force = {0.1 * k, 0.0, frame.t};
            sink_.step(row, {});
        }
    }

private:
    RunSink& sink_;
    double start_;
    uint32_t frames_ = 0, noise_ = 1;
};

std::string bytesOf(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

} // namespace

TEST_CASE("Packed images come back without loss, in less memory where neighbours are equal") {
    std::vector<uint16_t> depth{0, 1, 65535, 0, 32768, 32767, 700, 701, 699, 0};
    CHECK(unpackDepth(packDepth(depth), depth.size()) == depth);
    depth.assign(1000, 700);
    CHECK(packDepth(depth).size() <= 1001);
    CHECK(packDepth({}).empty());
    std::vector<uint32_t> colour(300, 0xff102030u);
    for (uint32_t i = 0; i < 300; ++i) {
        colour.push_back(0xff000000u | i * 7919u);
    }
    colour.push_back(colour.back());
    CHECK(unpackColour(packColour(colour), colour.size()) == colour);
    CHECK(packColour(colour).size() < 960);
    CHECK(packColour({}).empty());
}

TEST_CASE("The last 30 s are kept, and less where the memory does not hold them") {
    NoSink nothing;
    LastSeconds last(nothing, size_t{1} << 30);
    NoisyRun run(last);
    for (int i = 0; i < 1200; ++i) {
        run.image();
    }
    CHECK(last.seconds() == doctest::Approx(30.0).epsilon(0.002));
    const size_t bytes = last.bytes();
    LastSeconds small(nothing, bytes / 3);
    NoisyRun again(small);
    for (int i = 0; i < 1200; ++i) {
        again.image();
    }
    CHECK(small.bytes() <= bytes / 3);
    CHECK(small.seconds() == doctest::Approx(10.0).epsilon(0.05));
    NoisyRun restarted(small, 2.0); // the time of a run begins again
    restarted.image();
    restarted.image();
    restarted.image();
    CHECK(small.seconds() == doctest::Approx(1.0 / 30.0));
    LastSeconds none(nothing, 0);
    NoisyRun unseen(none);
    unseen.image();
    unseen.image();
    CHECK(none.past().frames.empty());
}

TEST_CASE(
    "While no frame comes, the ticks of 30 s are kept, and of less where the memory does not hold them") {
    NoSink nothing;
    const auto ticks = [](LastSeconds& sink, double from, double to) {
        for (TickRow row; row.record.t < to - from; row.record.t += 0.01) {
            TickRow now = row;
            now.record.t += from;
            sink.step(now, {});
        }
    };
    LastSeconds last(nothing, size_t{1} << 30);
    NoisyRun(last).image();
    ticks(last, 0.03, 30.01);
    const size_t bytes = last.bytes();
    CHECK(bytes > 2900 * sizeof(TickRow));
    ticks(last, 30.01, 90.0);
    CHECK(last.bytes() == bytes);
    LastSeconds small(nothing, bytes / 4);
    NoisyRun run(small);
    run.image();
    run.image();
    ticks(small, 0.07, 25.0);
    CHECK(small.bytes() <= bytes / 4);
    run.image();
    CHECK(small.bytes() <= bytes / 4);
}

TEST_CASE("Storing the last seconds gives the files that a recorder would have written") {
    const ScratchFolder scratch;
    const auto direct = scratch.path() / "direct", stored = scratch.path() / "stored";
    Recorder recorder, later;
    LastSeconds last(recorder, size_t{1} << 30);
    const RecordedScene plain{"plain", {}}, edited{"edited", {1}}, last2{"last", {}};
    last.edit({0, "scene", plain});
    recorder.start(direct, "scene", colourCamera(), plain);
    NoisyRun run(last);
    for (int i = 0; i < 20; ++i) {
        if (i == 8) {
            recorder.edit(1, edited);
            last.edit({1, "scene 1", edited});
        }
        if (i == 12) {
            recorder.mark();
            last.mark();
        }
        run.image(i < 10 ? 0 : 1);
    }
    recorder.stop();
    recorder.finish();
    run.image(1); // completes the ticks of the last one
    const KeptPast past = last.past();
    CHECK(past.frames.size() == 20);
    later.start(stored, past.first.text, colourCamera(), past.first.recorded);
    feed(later, past);
    later.stop();
    later.finish();
    CHECK(later.failure().empty());
    CHECK(later.frames() == 20);
    for (const char* file :
         {"associations.txt", "hand.csv", "wrench.csv", "touches.csv", "marks.csv", "scene.yaml", "edits.csv",
          "scene-0.yaml", "scene-1.yaml", "rgb/000013.png", "depth/000013.png"}) {
        CAPTURE(file);
        CHECK(bytesOf(direct / file) == bytesOf(stored / file));
        CHECK(!bytesOf(stored / file).empty());
    }
}
