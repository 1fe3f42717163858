// SPDX-License-Identifier: Apache-2.0
// The frame loop without other threads.
#include "engine/run/frame_loop.h"

#include <doctest/doctest.h>
#include <thread>

#include "tests/realtime/fake_scene.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Frames without pauses; `age` is the age of each when it arrives.
class LiveFeed final : public FrameFeed {
public:
    explicit LiveFeed(FakeFeed& feed)
        : feed_(feed) {}
    std::function<std::chrono::milliseconds(uint32_t)> age = [](uint32_t) {
        return std::chrono::milliseconds(20);
    };

    std::optional<uint32_t> fetch() override {
        const std::optional<uint32_t> index = feed_.fetch();
        taken_ = std::chrono::steady_clock::now() - age(index.value_or(0));
        return index;
    }
    std::optional<RunClock::Time> captured() const override { return taken_; }
    void publish(double t, PublishedFrame& out) override { feed_.publish(t, out); }

private:
    FakeFeed& feed_;
    RunClock::Time taken_;
};

// The loop on a live source of `frames` frames.
struct LiveLoop {
    explicit LiveLoop(uint32_t frames)
        : fake(frames, pressingPath(1.0)) {}
    void start() {
        REQUIRE(loop.first());
        clock.start(0.0);
    }

    FakeRun fake;
    LiveFeed feed{fake.feed};
    Channels channels{16};
    RunClock clock;
    FrameLoop loop{feed, channels, clock, 1000.0, nullptr}; // with pacing, a run would take hours
    std::atomic<bool> stop{false};
};

} // namespace

TEST_CASE("Frames are captured one period apart by the clock, and only a slow frame counts as lost") {
    FakeRun fake(12, pressingPath(1.0));
    fake.feed.beforePublish = [](uint32_t index) {
        if (index == 6) {
            std::this_thread::sleep_for(std::chrono::milliseconds(230));
        }
    };
    Channels channels(16);
    RunClock clock;
    FrameLoop loop(fake.feed, channels, clock, 0.05, nullptr);
    REQUIRE(loop.first());
    clock.start(0.0);
    std::atomic<bool> stop{false};
    loop.run(stop);
    REQUIRE(fake.feed.captured.size() == 12);
    CHECK(fake.feed.captured[0] == 0.0);
    for (size_t i = 1; i < 12; ++i) {
        CHECK(fake.feed.captured[i] > fake.feed.captured[i - 1]);
        CHECK(fake.feed.captured[i] >= 0.05 * static_cast<double>(i) - 1e-6);
    }
    CHECK(fake.feed.captured[7] >= 0.05 * 6 + 0.23 - 1e-6);
    CHECK(loop.lost() >= 3); // 230 ms last over four periods of 50 ms
    CHECK(loop.lost() <= 8);
    CHECK(loop.update().sourceEnded);
}

TEST_CASE("Frames of a live source keep their capture time, and the loop does not pace them") {
    LiveLoop live(8);
    live.start();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    live.loop.run(live.stop);
    REQUIRE(live.fake.feed.captured.size() == 8);
    CHECK(live.fake.feed.captured[0] == 0.0);
    CHECK(live.fake.feed.captured[1] >= 0.03 - 1e-6);
    for (size_t i = 1; i < 8; ++i) {
        CHECK(live.fake.feed.captured[i] >= live.fake.feed.captured[i - 1]);
        CHECK(live.fake.feed.captured[i] <= live.clock.now() - 0.02 + 1e-6);
    }
    CHECK(live.loop.lost() == 0);
    CHECK(live.loop.update().live);
}

TEST_CASE("A live camera whose stamps go back gives frames no older than the one before") {
    LiveLoop live(10);
    live.feed.age = [](uint32_t index) { return std::chrono::milliseconds(index == 5 ? 3600000 : 1); };
    live.fake.feed.beforeFetch = [](uint32_t) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); };
    live.start();
    live.loop.run(live.stop);
    const std::vector<double>& captured = live.fake.feed.captured;
    REQUIRE(captured.size() == 10);
    CHECK(captured[4] > 0.0);
    CHECK(captured[5] == captured[4]);
    CHECK(captured[6] > captured[5]);
    CHECK(live.loop.update().captureTime == captured[9]);
}

TEST_CASE("A run that is to stop ends although the writer returns none of its frames") {
    LiveLoop live(4 * Channels::kFramesInFlight);
    live.start();
    live.fake.feed.beforeFetch = [&](uint32_t index) { live.stop = index == Channels::kFramesInFlight; };
    live.loop.run(live.stop);
    CHECK(live.fake.feed.captured.size() == Channels::kFramesInFlight);
}
