// SPDX-License-Identifier: Apache-2.0
// Copies of regions and steps for a display.
#include "tests/engine/wall_world.h"
#include "tests/haptics/allocation_count.h"

#include <doctest/doctest.h>
#include <optional>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("An observer gets the newest regions once, as they protect the wall") {
    Engine engine(wallScene(), smallCamera());
    CameraPort camera = engine.camera();
    ObserverPort observer = engine.openObserver();
    CHECK_THROWS_AS(engine.openObserver(), Error);
    Regions regions;
    CHECK_FALSE(observer.regions(regions));
    CHECK(regions.frame == -1);
    const Wall wall;
    const Nanoseconds stamp = now();
    CHECK(camera.submit(wall.at(stamp)) == SubmitStatus::Accepted);
    CHECK(eventually([&] { return observer.regions(regions); }));
    CHECK(regions.frame == 0);
    CHECK(regions.stamp == stamp);
    REQUIRE(regions.spheres.size() > 100);
    for (const RegionSphere& sphere : regions.spheres) {
        CHECK(regions.origin[2] + sphere.centre[2] == doctest::Approx(0.6).epsilon(0.001));
        CHECK(sphere.radius >= 0.04f);
        CHECK(sphere.fixture == 0);
    }
    const size_t before = regions.spheres.size();
    CHECK_FALSE(observer.regions(regions)); // not again
    CHECK(regions.spheres.size() == before);
    for (int i = 0; i < 50; ++i) {
        CHECK(camera.submit(wall.at(now())) == SubmitStatus::Accepted);
    }
    CHECK(eventually([&] { return camera.processed() + camera.dropped() == 51; }));
    CHECK(observer.regions(regions)); // the newest alone
    CHECK_FALSE(observer.regions(regions));
    CHECK(regions.frame == 50);
}

TEST_CASE("An observer that is opened after the last frame gets its regions, and once") {
    Engine engine(wallScene(), smallCamera());
    CameraPort camera = engine.camera();
    const Wall wall;
    Nanoseconds stamp = 0;
    for (uint64_t i = 1; i <= 3; ++i) {
        stamp = now();
        CHECK(camera.submit(wall.at(stamp)) == SubmitStatus::Accepted);
        REQUIRE(eventually([&] { return camera.processed() == i; }));
    }
    ObserverPort observer = engine.openObserver();
    Regions regions;
    REQUIRE(observer.regions(regions));
    CHECK(regions.frame == 2);
    CHECK(regions.stamp == stamp);
    CHECK(regions.spheres.size() > 100);
    CHECK_FALSE(observer.regions(regions));
    CHECK(camera.submit(wall.at(now())) == SubmitStatus::Accepted);
    CHECK(eventually([&] { return observer.regions(regions); }));
    CHECK(regions.frame == 3);
}

TEST_CASE("An observer gets the newest step once, without allocation") {
    std::optional<Engine> engine(std::in_place, wallScene(), smallCamera());
    HandPort hand = engine->openHand(startAt(0.5));
    ObserverPort observer = engine->openObserver();
    StepSnapshot seen;
    CHECK_FALSE(observer.step(seen));
    Nanoseconds last = 0;
    for (int i = 0; i < 10; ++i) {
        last = now();
        hand.step(handAt(0.5 + 0.001 * i), last);
    }
    const uint64_t before = threadAllocationCount();
    CHECK(observer.step(seen));
    CHECK_FALSE(observer.step(seen));
    CHECK(threadAllocationCount() == before);
    CHECK(seen.now == last);
    CHECK(seen.hand.deviceThandle.position[2] == 0.509);
    CHECK(warns(seen.step, StepWarning::NoScene));
    engine.reset(); // the ports live on
    const Step step = hand.step(handAt(0.52), now());
    CHECK(observer.step(seen));
    CHECK(seen.step.baseTcommand.position[2] == step.baseTcommand.position[2]);
    Regions regions;
    CHECK_FALSE(observer.regions(regions));
}

TEST_CASE("Lockstep gives the regions of its newest frame and the times of each") {
    Lockstep run(wallScene(), smallCamera(), startAt(0.5));
    Regions regions;
    CHECK_FALSE(run.regions(regions));
    CHECK(regions.frame == -1);
    const Wall wall;
    for (Nanoseconds stamp : {10, 20}) {
        const FrameTimes times = run.process(wall.at(stamp));
        CHECK(times.upload > 0.0);
        CHECK(times.compute > 0.0);
        CHECK(times.published >= times.upload + times.compute);
        REQUIRE(run.regions(regions));
        CHECK(regions.stamp == stamp);
    }
    CHECK(regions.frame == 1);
    CHECK(regions.spheres.size() == 80 * 60);
    CHECK(regions.origin[2] + regions.spheres[0].centre[2] == doctest::Approx(0.6).epsilon(0.001));
}
