// SPDX-License-Identifier: Apache-2.0
#include "engine/run/posture_track.h"

#include "engine/run/frame_loop.h"

#include <doctest/doctest.h>
#include <thread>

using namespace fathom;

namespace {

PostureTrack::Time at(double milliseconds) {
    return PostureTrack::Time(std::chrono::nanoseconds(static_cast<int64_t>(milliseconds * 1e6)));
}

ArmPosture posture(double value) {
    ArmPosture p;
    p.q.fill(value);
    p.grasp = value;
    return p;
}

// Frames of a live camera that arrive late; captured at 20, 40, 60 ... ms of the run.
struct LateFeed final : FrameFeed {
    explicit LateFeed(const RunClock& runClock)
        : clock(runClock) {}
    const RunClock& clock;
    uint32_t index = 0;
    std::vector<double> shownAt;

    std::optional<uint32_t> fetch() override {
        ++index;
        return index <= 5 ? std::optional(index) : std::nullopt;
    }
    std::optional<RunClock::Time> captured() const override { return clock.timeAt(0.02 * index); }
    void armAtCapture(const ArmPosture& arm) override { shownAt.push_back(arm.grasp); }
    void publish(double, PublishedFrame& out) override { out.changed = false; }
};

} // namespace

TEST_CASE("The self-filter gets the posture of the capture time, not the newest") {
    Channels channels(1024);
    RunClock clock;
    LateFeed feed(clock);
    FrameLoop loop(feed, channels, clock, 0.02, nullptr);
    REQUIRE(loop.first());
    CHECK(feed.shownAt.empty()); // no tick yet
    clock.start(0.0);
    for (int i = 0; i < 200; ++i) { // the arm has moved on long before the frames arrive
        channels.postures.add(clock.timeAt(0.002 * i), posture(i));
    }
    std::atomic<bool> stop{false};
    loop.run(stop);
    CHECK(feed.shownAt == std::vector<double>{20.0, 30.0, 40.0, 50.0});
}

TEST_CASE(
    "The nearest posture in time is found, the newest and oldest at the ends, and none before the first") {
    PostureTrack track;
    CHECK_FALSE(track.nearest(at(0)));
    for (int i = 0; i < 7; ++i) {
        track.add(at(100.0 + 10.0 * i), posture(i));
    }
    const auto found = [&](double t) { return track.nearest(at(t))->grasp; };
    CHECK(found(0) == 0.0);
    CHECK(found(104) == 0.0);
    CHECK(found(106) == 1.0);
    CHECK(found(130) == 3.0);
    CHECK(found(999) == 6.0);
    CHECK(track.nearest(at(130))->q[kMaxJoints - 1] == 3.0);
}

TEST_CASE("The track keeps half a second at any rate, and skips postures that follow too soon") {
    PostureTrack track;
    for (int i = 0; i < 3000; ++i) {
        track.add(at(i), posture(i));
    }
    CHECK(track.nearest(at(2998))->grasp == 2998.0); // every other millisecond is kept
    CHECK(track.nearest(at(2600))->grasp == 2600.0);
    const double oldest = track.nearest(at(0))->grasp;
    CHECK(oldest <= 2500.0);
    CHECK(oldest >= 2998.0 - 2.0 * PostureTrack::kKept);
}

TEST_CASE("A reader on another thread never gets parts of two postures") {
    PostureTrack track;
    std::atomic<bool> stop{false};
    std::thread writer([&] {
        for (int i = 1; !stop.load(); ++i) {
            track.add(at(10.0 * i), posture(i)); // overwrites while the other thread reads
        }
    });
    uint64_t torn = 0, seen = 0;
    for (int i = 0; i < 20000 || seen < 100; ++i) {
        if (const auto p = track.nearest(at(5e3))) { // the oldest one, which is overwritten next
            ++seen;
            for (double q : p->q) {
                torn += q != p->grasp;
            }
        }
    }
    stop.store(true);
    writer.join();
    CHECK(torn == 0);
}
