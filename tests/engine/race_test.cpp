// SPDX-License-Identifier: Apache-2.0
// Concurrent submissions, steps, a lost device and destruction of the engine, for the thread sanitizer.
#include "tests/engine/wall_world.h"
#include "tests/rig/losing.h"
#include "tests/support/scratch_folder.h"

#include <atomic>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <optional>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Frames, steps, a lost device and destruction may overlap") {
    const ScratchFolder folder;
    const auto trigger = folder / "trigger";
    const Losing losing(trigger.string(), 1);
    std::optional<Engine> engine(std::in_place, wallScene(), smallCamera());
    std::atomic<bool> stop{false}, lost{false};
    std::atomic<uint64_t> steps{0}, afterEnd{0};
    std::thread camera([&, port = engine->camera()]() mutable {
        const Wall wall;
        while (!stop) {
            const SubmitStatus status = port.submit(wall.at(now()));
            afterEnd += status == SubmitStatus::Closed ? 1 : 0;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    });
    std::thread haptic([&, hand = engine->openHand(startAt(0.5))]() mutable {
        while (!stop) {
            const Step step = hand.step(handAt(0.555), now());
            lost = lost || warns(step, StepWarning::ComputeDeviceLost);
            CHECK(step.baseTtool.position[2] < 0.551); // never into the wall
            ++steps;
            std::this_thread::sleep_for(std::chrono::microseconds(500));
        }
    });
    CameraPort port = engine->camera();
    CHECK(eventually([&] { return port.processed() >= 5; }));
    std::ofstream(trigger) << "passes";
    CHECK(eventually([&] { return lost.load(); }));
    CHECK(eventually([&] { return !engine->computeDeviceLost() && !std::filesystem::exists(trigger); }));
    const uint64_t before = port.processed();
    CHECK(eventually([&] { return port.processed() >= before + 5; })); // the device is back
    CHECK(engine->failure().empty());
    engine.reset(); // while both threads still run
    const uint64_t then = steps;
    CHECK(eventually([&] { return steps > then + 100 && afterEnd > 5; }));
    stop = true;
    camera.join();
    haptic.join();
}

TEST_CASE("The end of an engine without frames does not hang") {
    for (int i = 0; i < 3; ++i) {
        const Engine engine(wallScene(), smallCamera());
    }
}
