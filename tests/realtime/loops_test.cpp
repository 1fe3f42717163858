// SPDX-License-Identifier: Apache-2.0
// The loops one at a time, without threads.
#include "apps/binding/spooled_camera.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/run/contact_loop.h"
#include "engine/run/frame_loop.h"
#include "engine/run/haptic_loop.h"
#include "engine/run/record_drain.h"
#include "engine/types/error.h"
#include "tests/haptics/allocation_count.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>
#include <thread>

#include "tests/realtime/fake_scene.h"
#include "tests/support/scratch_folder.h"

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A haptic tick allocates nothing, with contact sets, guidance and a trace") {
    FakeRun fake(2, wipingPath(2.0));
    Channels channels(4096);
    RunClock clock;
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "trace.json";
    CadenceTrace trace(file, {});
    HapticCycle cycle(fake.tool, {}, fake.options, fake.path.at(0.0).deviceThandle);
    HapticLoop loop(cycle, fake.hand, channels, clock, {}, &trace);
    FrameLoop frames(fake.feed, channels, clock, 1.0 / 30.0, nullptr);
    REQUIRE(frames.first());
    SceneUpdate update = frames.update();
    update.guidanceCount = 1;
    update.guidance[0].present = true;
    update.guidance[0].target = at(0.0, 0.0, 0.05);

    uint64_t during = 0, contacts = 0;
    uint64_t query = 0;
    TickRow row;
    clock.start(0.0);
    const uint64_t beforeAny = allocationCount();
    for (int i = 0; i < 1000; ++i) {
        ContactSet& set = channels.contacts.back();
        REQUIRE(fake.answers.answer({cycle.place()}, set));
        query = set.query;
        channels.contacts.publish();
        update.captureTime = clock.now();
        channels.scene.back() = update;
        channels.scene.publish();
        const uint64_t before = allocationCount();
        loop.step(clock.now());
        during += allocationCount() - before;
        REQUIRE(channels.ticks.pop(row));
        CHECK(row.query == query);
        contacts += row.record.contactCount > 0 ? 1 : 0;
        std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    CHECK(allocationCount() > beforeAny); // the counter works
    CHECK(during == 0);
    CHECK(contacts > 100);
    trace.file().finish();
}

TEST_CASE("A tick whose set has not reached the writer waits for it, and passes at the end in any case") {
    FakeRun fake(2, pressingPath(1.0));
    Channels channels(16);
    RecordDrain drain(channels, fake.sink);
    TickRow row;
    channels.ticks.push(row); // uses no set
    row.generation = 1;
    row.query = 1;
    channels.ticks.push(row);
    drain.drain();
    CHECK(fake.sink.rows.size() == 1);

    RunClock clock;
    FrameLoop frames(fake.feed, channels, clock, 0.05, nullptr);
    REQUIRE(frames.first());
    channels.queries.push({1, 5.0, {0}});
    drain.drain();
    CHECK(fake.sink.rows.size() == 2);
    CHECK(fake.sink.unknown == 0);

    row.generation = 7; // never arrives
    channels.ticks.push(row);
    drain.drain();
    CHECK(fake.sink.rows.size() == 2);
    drain.drain(true);
    CHECK(fake.sink.rows.size() == 3);
    CHECK(fake.sink.unknown == 1); // cannot be audited
}

TEST_CASE("A tick that obeys the set before the last obeyed one is audited, as after the loss of a device") {
    FakeRun fake(4, pressingPath(1.0));
    Channels channels(16);
    RecordDrain drain(channels, fake.sink);
    RunClock clock;
    FrameLoop frames(fake.feed, channels, clock, 0.0, nullptr);
    TickRow row;
    for (const uint64_t generation : {1u, 2u, 3u, 2u, 3u, 1u}) {
        if (generation > fake.sink.frames) {
            REQUIRE(frames.first());
        }
        row.generation = generation;
        channels.queries.push({++row.query, 5.0, {}});
        channels.ticks.push(row);
        drain.drain();
    }
    CHECK(fake.sink.rows.size() == 6);
    CHECK(fake.sink.unknown == 1); // the set before that one is no longer kept
}

TEST_CASE("Sets that no tick can use any more go back to the frame cycle") {
    FakeRun fake(400, pressingPath(1.0));
    Channels channels(16);
    RecordDrain drain(channels, fake.sink);
    RunClock clock;
    FrameLoop frames(fake.feed, channels, clock, 0.0, nullptr);
    REQUIRE(frames.first());
    TickRow row;
    for (uint64_t generation = 1; generation < 300; ++generation) {
        REQUIRE(frames.first()); // fetches the next frame
        row.generation = generation;
        channels.ticks.push(row);
        drain.drain();
    }
    CHECK(drain.newest()->fixtures.generation == 300);
    for (int i = 0; i < 99; ++i) {
        REQUIRE(frames.first()); // no tick uses these sets: the writer releases the oldest
        drain.drain();
    }
    CHECK(fake.sink.frames == 399);
    CHECK(drain.newest()->fixtures.generation == 399);
}

TEST_CASE("A spooled camera returns exactly the frames of its source, once, and leaves no file behind") {
    SimulatedCameraOptions options;
    options.width = 70;
    options.height = 50;
    options.frames = 5;
    SimulatedCamera plain(*analyticScene("tank"), options);
    const testing::ScratchFolder scratch;
    const auto folder = scratch.path() / "spool";
    std::filesystem::create_directories(folder);
    std::atomic<bool> stop{false};
    uint64_t reported = 0;
    SpooledCamera spooled(std::make_unique<SimulatedCamera>(*analyticScene("tank"), options), folder, stop,
                          [&](uint64_t frames) { reported = frames; });
    CHECK(reported == 5);
    CHECK(std::filesystem::is_empty(folder));
    while (auto wanted = plain.next()) {
        const auto frame = spooled.next();
        REQUIRE(frame.has_value());
        CHECK((*frame)->index == (*wanted)->index);
        CHECK((*frame)->sourceNumber == (*wanted)->sourceNumber);
        CHECK(std::ranges::equal((*frame)->depth, (*wanted)->depth));
        CHECK(std::ranges::equal((*frame)->colour, (*wanted)->colour));
        CHECK((*frame)->baseTcamera->position == (*wanted)->baseTcamera->position);
    }
    CHECK_FALSE(spooled.next().has_value());

    options.yuyv = true;
    SimulatedCamera sender(*analyticScene("tank"), options);
    SpooledCamera packed(std::make_unique<SimulatedCamera>(*analyticScene("tank"), options), folder, stop,
                         [](uint64_t) {});
    const auto sent = sender.next(), kept = packed.next();
    CHECK(packed.info().colourFormat == ColourFormat::Yuyv);
    CHECK((*kept)->colour.empty());
    CHECK((*kept)->raw.bytes.size() == 2 * 70 * 50);
    CHECK(std::ranges::equal((*kept)->raw.bytes, (*sent)->raw.bytes));

    stop = true; // asked to stop, but the first frame is kept
    SpooledCamera one(std::make_unique<SimulatedCamera>(*analyticScene("tank"), options), folder, stop,
                      [](uint64_t) {});
    CHECK(one.next().has_value());
    CHECK_FALSE(one.next().has_value());
    std::filesystem::remove(folder);
    const auto unspooled = [&] {
        SpooledCamera nowhere(std::make_unique<SimulatedCamera>(*analyticScene("tank"), options), folder,
                              stop, [](uint64_t) {});
    };
    CHECK_THROWS_AS(unspooled(), Error);
}

TEST_CASE("A spooled camera for runs without points takes one frame and delivers it as new ones") {
    SimulatedCameraOptions options;
    options.width = 70;
    options.height = 50;
    SimulatedCamera plain(*analyticScene("tank"), options);
    const auto first = plain.next();
    const testing::ScratchFolder scratch;
    const std::atomic<bool> stop{false};
    uint64_t taken = 0;
    SpooledCamera still(
        std::make_unique<SimulatedCamera>(*analyticScene("tank"), options), scratch.path(), stop,
        [&](uint64_t frames) { taken = frames; }, 7);
    CHECK(taken == 1);
    for (uint32_t i = 0; i < 7; ++i) {
        const auto frame = still.next();
        REQUIRE(frame.has_value());
        CHECK((*frame)->index == i);
        CHECK((*frame)->sourceNumber == (*first)->sourceNumber + i);
        CHECK(std::ranges::equal((*frame)->depth, (*first)->depth));
        CHECK(std::ranges::equal((*frame)->colour, (*first)->colour));
    }
    CHECK_FALSE(still.next().has_value());
}

TEST_CASE("A run that waits for rendered frames says after a second what it waits for and how long") {
    CHECK(spoolNotice(30, 240, 0.9) == "");
    CHECK(spoolNotice(240, 240, 9.0) == "");
    CHECK(spoolNotice(12, 240, 1.2) ==
          "the run waits until the simulated camera has rendered its 240 frames, about 24 s; "
          "camera.source.frames sets how many");
}

TEST_CASE("The haptic thread has a CPU that no other thread uses") {
    const ThreadPlacement placement = ThreadPlacement::ofThisProcess();
    REQUIRE(!placement.all.empty());
    REQUIRE(placement.haptic.size() == 1);
    if (!placement.pinned()) {
        MESSAGE("SKIPPED: there is only one CPU");
        return;
    }
    for (const auto& others : {placement.contact, placement.rest}) {
        CHECK(!others.empty());
        CHECK(std::ranges::find(others, placement.haptic[0]) == others.end());
    }
    const CpuConfinement confined(placement.rest);
    CHECK(ThreadPlacement::ofThisProcess().all == placement.rest);
}

TEST_CASE("A single wrong sample of the hand does not move the tool of a run") {
    FakeRun fake(2, pressingPath(1.0));
    Channels channels(16);
    RunClock clock;
    FrameLoop frames(fake.feed, channels, clock, 1.0 / 30.0, nullptr);
    REQUIRE(frames.first());
    channels.scene.back() = frames.update();
    channels.scene.publish();
    HandSample sample = fake.path.at(0.0);
    HapticCycle cycle(fake.tool, {}, fake.options, sample.deviceThandle);
    HapticStepper stepper(cycle, channels, clock);
    dvec3 before(0.0);
    for (int i = 0; i < 50; ++i) {
        REQUIRE(fake.answers.answer({cycle.place()}, channels.contacts.back()));
        channels.contacts.publish();
        HandSample now = sample;
        now.deviceThandle.position.x += i == 40 ? 0.2 : 0.0;
        const dvec3 tool = stepper.step(now, 0.001 * i, 1e9).tool.position;
        CHECK((i < 40 || glm::distance(tool, before) < 1e-9));
        before = tool;
    }
}
