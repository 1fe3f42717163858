// SPDX-License-Identifier: Apache-2.0
// The public interface: statuses, counts, ownership of borrowed frames, and restrictions on a step.
#include "tests/engine/wall_world.h"
#include "tests/haptics/allocation_count.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <optional>
#include <string>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Missing, future and decreasing stamps each have a status, and a clock jump has a call") {
    Engine engine(wallScene(), smallCamera());
    CameraPort port = engine.camera();
    const Wall wall;
    const Nanoseconds t = now();
    CHECK(port.submit(wall.at(0)) == SubmitStatus::MissingStamp);
    CHECK(port.submit(wall.at(-5)) == SubmitStatus::MissingStamp);
    CHECK(port.submit(wall.at(now() + 50'000'000)) == SubmitStatus::StampAhead);
    CHECK(port.submit(wall.at(t)) == SubmitStatus::Accepted);
    CHECK(port.submit(wall.at(t)) == SubmitStatus::StampBack);
    CHECK(port.submit(wall.at(t - 1)) == SubmitStatus::StampBack);
    port.clockJumped();
    CHECK(port.submit(wall.at(t - 1)) == SubmitStatus::Accepted);
    CHECK(port.submit(wall.at(now() + 2'000'000)) == SubmitStatus::Accepted); // within 5 ms
}

TEST_CASE("A frame without an image or with a broken pose is rejected") {
    Engine engine(wallScene(), smallCamera());
    CameraPort port = engine.camera();
    const Wall wall;
    Frame frame = wall.at(now());
    frame.depth = nullptr;
    CHECK(port.submit(frame) == SubmitStatus::MissingImage);
    frame = wall.at(now());
    frame.baseTcamera.position[1] = std::nan("");
    CHECK(port.submit(frame) == SubmitStatus::BadPose);
    frame = wall.at(now());
    frame.baseTcamera.rotation = {0.0, 0.0, 0.0, 0.0};
    CHECK(port.submit(frame) == SubmitStatus::BadPose);
}

TEST_CASE("Every accepted frame is processed or counted as dropped, and the newest wins") {
    Engine engine(wallScene(), smallCamera());
    CameraPort port = engine.camera();
    const Wall wall;
    uint64_t accepted = 0;
    for (int i = 0; i < 200; ++i) {
        accepted += port.submit(wall.at(now())) == SubmitStatus::Accepted ? 1 : 0;
    }
    CHECK(accepted == 200);
    CHECK(eventually([&] { return port.processed() + port.dropped() == accepted; }));
    CHECK(port.dropped() > 100); // far faster than any frame is processed
    CHECK(port.processed() >= 1);
}

TEST_CASE("Two cameras, an unknown camera and another hand are rejected with one clear line") {
    const std::vector<CameraModel> two{smallCamera(), smallCamera()};
    CHECK_THROWS_WITH_AS(Engine(wallScene(), two),
                         "cameras: 2 (allowed: 1; several cameras are not supported yet)", BadInput);
    Engine engine(wallScene(), smallCamera());
    CHECK_THROWS_AS(engine.camera(1), BadInput);
    CHECK_THROWS_AS(engine.camera("other"), BadInput);
    CHECK_NOTHROW(engine.camera("camera"));
    HandPort hand = engine.openHand(startAt(0.5));
    CHECK_THROWS_AS(engine.openHand(startAt(0.5)), Error);
    CHECK_THROWS_AS(Scene::fromText("fixtures: 3"), BadInput);
}

TEST_CASE("Names of cameras cannot break the line of a message or control a terminal") {
    CameraModel model = smallCamera();
    model.name = "wr\nist\x1b[31m";
    Engine engine(boxScene(), model);
    CHECK_THROWS_WITH_AS(engine.camera("foo\nbar"), "camera: 'foo bar' (allowed: 'wr ist [31m')", BadInput);
    CHECK_NOTHROW(engine.camera("wr\nist\x1b[31m"));
}

TEST_CASE("A port of a camera stays usable when it is moved, which copies it") {
    Engine engine(boxScene(), smallCamera());
    CameraPort first = engine.camera();
    CameraPort second(
        static_cast<CameraPort&&>(first)); // std::move() of what is used again looks like a fault
    const Wall wall;
    CHECK(first.submit(wall.at(now())) == SubmitStatus::Accepted);
    CHECK(second.submit(wall.at(now())) == SubmitStatus::Accepted);
    first = static_cast<CameraPort&&>(second);
    CHECK(second.dropped() == first.dropped());
}

TEST_CASE("A hand that could not be opened does not keep another one out") {
    Engine engine(wallScene(), smallCamera());
    CHECK_THROWS_AS(engine.openHand(startAt(std::nan(""))), BadInput);
    CHECK_NOTHROW(engine.openHand(startAt(0.5)));
}

TEST_CASE("A borrowed frame is released exactly once, whatever happens to it") {
    const Wall wall;
    constexpr int kFrames = 60;
    std::vector<std::atomic<int>> released(kFrames + 3);
    const auto release = [&](int i) { return [&released, i] { ++released[static_cast<size_t>(i)]; }; };
    std::optional<Engine> engine(std::in_place, wallScene(), smallCamera());
    CameraPort port = engine->camera();
    CHECK(port.lend(wall.at(0), release(kFrames)) == SubmitStatus::MissingStamp);
    CHECK(released[kFrames] == 1);
    for (int i = 0; i < kFrames; ++i) {
        CHECK(port.lend(wall.at(now()), release(i)) == SubmitStatus::Accepted);
        std::this_thread::sleep_for(std::chrono::milliseconds(i % 3));
    }
    engine.reset(); // a frame may still be waiting
    CHECK(port.lend(wall.at(now()), release(kFrames + 1)) == SubmitStatus::Closed);
    for (int i = 0; i < kFrames + 2; ++i) {
        CHECK(released[static_cast<size_t>(i)] == 1);
    }
}

TEST_CASE("Borrowed depth in metres is copied and released at once") {
    CameraModel model = smallCamera();
    model.depthFormat = DepthFormat::Metres;
    Engine engine(wallScene(), model);
    const std::vector<float> depth(80 * 60, 0.6f);
    Frame frame;
    frame.depth = depth.data();
    frame.stamp = now();
    int released = 0;
    CHECK(engine.camera().lend(frame, [&] { ++released; }) == SubmitStatus::Accepted);
    CHECK(released == 1);
}

TEST_CASE("A submission without memory for its copy gives back all that it took, and a later one succeeds") {
    CameraModel model = smallCamera();
    model.depthFormat = DepthFormat::Metres;
    Engine engine(wallScene(), model);
    CameraPort port = engine.camera();
    const std::vector<float> depth(80 * 60, 0.6f);
    Frame frame;
    frame.depth = depth.data();
    int released = 0;
    const auto lend = [&](bool fail) {
        std::function<void()> release = [&] { ++released; };
        frame.stamp = now();
        if (fail) {
            failNextAllocation();
        }
        return port.lend(frame, std::move(release));
    };
    constexpr int kFailures = 6; // more than there are copies
    for (int i = 1; i <= kFailures; ++i) {
        CHECK_THROWS_AS(lend(true), std::bad_alloc);
        CHECK(released == i);
    }
    CHECK(lend(false) == SubmitStatus::Accepted);
    CHECK(released == kFailures + 1);
    CHECK(eventually([&] { return port.processed() == 1; }));
}

TEST_CASE("A step does not allocate and keeps the caller's floating-point mode") {
    Engine engine(wallScene(), smallCamera());
    CameraPort port = engine.camera();
    HandPort hand = engine.openHand(startAt(0.5));
    const Wall wall;
    uint64_t during = 0, contacts = 0;
    double z = 0.5;
    bool kept = true;
    for (int i = 0; i < 20000 && contacts < 100; ++i) {
        if (i % 20 == 0) {
            CHECK(port.submit(wall.at(now())) == SubmitStatus::Accepted);
        }
        const Hand sample = handAt(z);
        const uint64_t before = threadAllocationCount();
#if defined(__SSE2__)
        _mm_setcsr(0x9fc0); // denormals are zero, flush to zero
#endif
        const Step step = hand.step(sample, now());
#if defined(__SSE2__)
        kept = kept && (_mm_getcsr() & 0xffc0u) == 0x9fc0u;
        _mm_setcsr(0x1f80);
#endif
        during += threadAllocationCount() - before;
        z = std::min(0.56, z + (step.frame >= 0 ? 0.0005 : 0.0));
        contacts += step.state == State::Contact ? 1 : 0;
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    CHECK(contacts == 100);
    CHECK(during == 0);
    CHECK(kept);
    const uint64_t before = threadAllocationCount();
    CHECK(!std::string(100, 'x').empty());        // too long for small-string storage, so it allocates
    CHECK(threadAllocationCount() == before + 1); // the counter works
}

#if defined(__SSE2__)
namespace {

constexpr unsigned kCoarse = 0xffc0; // round towards zero, denormals are zero, flush to zero, no traps

// Presses into the wall and slides along it.
std::vector<Hand> slide() {
    std::vector<Hand> hands(600);
    for (size_t i = 0; i < hands.size(); ++i) {
        const double way = 0.0001 * static_cast<double>(i);
        hands[i].deviceThandle.position = {way / 3.0, 0.0, 0.5 + way};
    }
    return hands;
}

// In lockstep, with every call in the given floating-point mode.
std::vector<Step> stepsIn(unsigned mode, const std::vector<Hand>& hands) {
    std::vector<Step> steps(hands.size());
    const Wall wall;
    _mm_setcsr(mode);
    Lockstep lockstep(wallScene(), smallCamera(), startAt(0.5));
    bool kept = true;
    for (size_t i = 0; i < hands.size(); ++i) {
        const Nanoseconds t = 1'000'000 * static_cast<Nanoseconds>(i + 1);
        if (i % 100 == 0) {
            lockstep.process(wall.at(t));
        }
        lockstep.queryContacts();
        steps[i] = lockstep.step(hands[i], t);
        kept = kept && (_mm_getcsr() & 0xffc0u) == (mode & 0xffc0u);
    }
    _mm_setcsr(0x1f80);
    CHECK(kept);
    return steps;
}

} // namespace

TEST_CASE("The caller's floating-point mode changes no result and is kept by every call") {
    const std::vector<Hand> hands = slide();
    const std::vector<Step> usual = stepsIn(0x1f80, hands), coarse = stepsIn(kCoarse, hands);
    REQUIRE(usual.back().state == State::Contact);
    REQUIRE(usual.size() == coarse.size());
    for (size_t i = 0; i < usual.size(); ++i) {
        CAPTURE(i);
        REQUIRE(usual[i].wrench.force == coarse[i].wrench.force);
        REQUIRE(usual[i].baseTtool.position == coarse[i].baseTtool.position);
        REQUIRE(usual[i].state == coarse[i].state);
    }
}

TEST_CASE("Readings that are not finite are no error for a caller that traps invalid operations") {
    CameraModel model = smallCamera();
    model.depthFormat = DepthFormat::Metres;
    Engine engine(wallScene(), model);
    CameraPort port = engine.camera();
    const std::vector<float> depth(80 * 60, std::nanf(""));
    Frame frame;
    frame.depth = depth.data();
    frame.stamp = now();
    _mm_setcsr(0x1f80 & ~0x80u); // traps
    const SubmitStatus status = port.submit(frame);
    CHECK((_mm_getcsr() & 0xffc0u) == 0x1f00u);
    _mm_setcsr(0x1f80);
    CHECK(status == SubmitStatus::Accepted);
}
#endif

TEST_CASE("A step reports a missing scene, an old scene and time that goes back") {
    Engine engine(wallScene(), smallCamera());
    CameraPort port = engine.camera();
    HandPort hand = engine.openHand(startAt(0.5));
    Step step = hand.step(handAt(0.5), now());
    CHECK(warns(step, StepWarning::NoScene));
    CHECK(step.state == State::Off);
    const Wall wall;
    CHECK(port.submit(wall.at(now() - 3'000'000'000)) == SubmitStatus::Accepted); // keeps its age of 3 s
    CHECK(eventually([&] { return hand.step(handAt(0.5), now()).frame >= 0; }));
    step = hand.step(handAt(0.5), now());
    CHECK_FALSE(warns(step, StepWarning::NoScene));
    CHECK(warns(step, StepWarning::OldScene));
    CHECK(step.sceneAge > 2.9);
    step = hand.step(handAt(0.5), now() - 1'000'000'000);
    CHECK(warns(step, StepWarning::TimeBack));
    step = hand.step(handAt(std::nan("")), now());
    CHECK(warns(step, StepWarning::NotFinite));
    CHECK(step.wrench.force == Vec3{0.0, 0.0, 0.0});
}

TEST_CASE("Log lines go to the callback") {
    std::atomic<int> lines{0};
    setLogCallback([&](LogLevel, std::string_view line) { lines += line.empty() ? 0 : 1; });
    { const Engine engine(wallScene(), smallCamera()); }
    setLogCallback(nullptr);
    CHECK(lines > 0);
    CHECK(std::strcmp(version(), "0.2.0") == 0);
}
