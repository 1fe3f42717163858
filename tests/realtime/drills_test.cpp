// SPDX-License-Identifier: Apache-2.0
// Drills: faults from outside, with the force that the hand feels, when it is gone and when it returns.
// docs/robustness.md lists them all.
#include "engine/types/error.h"

#include <doctest/doctest.h>
#include <thread>
#include <utility>

#include "tests/realtime/fake_scene.h"
#include "tests/realtime/listening.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Fade {
    double full = 0.0;    // [N] before the fault
    double untouched = 0; // [s] from the last frame until the force decreases
    double gone = -1.0;   // [s] from the last frame until there is no force; -1 = always some
    double back = -1.0;   // [s] from the next frame until the force is full; -1 = not tested
    double deepest = 0.0; // [m] penetration
    bool marked = true;   // the state was `fading` exactly while the scene was too old
};

// No force steps beyond the slew limit, and none is left when the frame is 0.61 s old. Where periods were
// missed before that, at most what the slew limit leaves of the last force. Returns the number of ticks with
// such a scene.
size_t checkFades(const FakeRun& fake) {
    const double step = fake.options.slewForce * fake.options.period;
    size_t old = 0, leaps = 0, forced = 0;
    dvec3 before(0.0);
    for (const TickRow& row : fake.sink.rows) {
        const dvec3 force = row.record.wrench.force;
        const double most = std::max(0.0, glm::length(before) - step) + 1e-9;
        leaps += glm::distance(force, before) > step + 1e-9 ? 1 : 0;
        old += row.record.sceneAge > 0.61 ? 1 : 0;
        forced += row.record.sceneAge > 0.61 && glm::length(force) > most ? 1 : 0;
        before = force;
    }
    CHECK(leaps == 0);
    CHECK(forced == 0);
    return old;
}

// A hand presses 10 mm into a wall; frames come every 33 ms, then none for `stall` seconds. Simulated time.
Fade stallCamera(double stall, bool comesBack) {
    HapticRig rig(handScene(), at(0.0, 0.0, 0.03));
    rig.show(wallSet(1));
    Fade fade;
    uint64_t generation = 1;
    const auto tick = [&](bool image) {
        if (image) {
            rig.show(wallSet(++generation));
        }
        const StepRecord record = rig.step();
        const double force = forceOf(record);
        fade.marked = fade.marked && (record.state == StepState::Fading) == (record.sceneAge > kStaleAfter);
        fade.deepest = std::max(fade.deepest, -rig.gap());
        return force;
    };
    for (int i = 0; i < 330; ++i) {
        rig.hand.position.z = std::max(0.0, 0.03 - 0.0002 * i);
        fade.full = tick(i % 33 == 0);
    }
    tick(true);
    fade.untouched = stall;
    for (int i = 1; i <= static_cast<int>(std::lround(stall * 1000.0)); ++i) {
        const double force = tick(false);
        if (force < 0.999 * fade.full) {
            fade.untouched = std::min(fade.untouched, 0.001 * i);
        }
        if (force == 0.0 && fade.gone < 0.0) {
            fade.gone = 0.001 * i;
        }
    }
    for (int i = 1; comesBack && i <= 1000 && fade.back < 0.0; ++i) {
        if (tick(i % 33 == 1) > 0.999 * fade.full) {
            fade.back = 0.001 * i;
        }
    }
    return fade;
}

void checkSafeEnd(const FakeRun& fake) {
    CHECK(fake.hand.last.force == dvec3(0.0));
    CHECK(fake.hand.last.torque == dvec3(0.0));
    CHECK(fake.run->recordsLost() == 0);
    CHECK(fake.sink.audit.maxPenetration() <= 1e-5);
}

} // namespace

TEST_CASE("Drill: a camera that stalls for 100 ms changes no force") {
    const Fade fade = stallCamera(0.1, true);
    CHECK(fade.full > 5.0);
    CHECK(fade.untouched == doctest::Approx(0.1));
    CHECK(fade.gone < 0.0);
    CHECK(fade.deepest < 1e-5);
    CHECK(fade.marked);
}

TEST_CASE("Drill: a camera that stalls for 1 s takes the force away by 610 ms, and it is back 0.51 s after "
          "the next frame") {
    const Fade fade = stallCamera(1.0, true);
    CHECK(fade.untouched >= 0.1);
    CHECK(fade.gone > 0.5); // not a step: it fades over 0.5 s
    CHECK(fade.gone <= 0.61);
    CHECK(fade.back > 0.2); // the limit of 20 N rises within 0.5 s
    CHECK(fade.back <= 0.51);
    CHECK(fade.deepest < 1e-5);
    CHECK(fade.marked);
}

TEST_CASE("Drill: a camera that stalls for 1 s under threads logs when forces fade and when they return") {
    for (const double stall : {0.0, 1.0}) {
        CAPTURE(stall);
        FakeRun fake(stall > 0.0 ? 30 : 15, pressingPath(stall > 0.0 ? 2.2 : 0.5));
        fake.feed.beforeFetch = [stall](uint32_t index) {
            if (index == 12) {
                std::this_thread::sleep_for(std::chrono::duration<double>(stall));
            }
        };
        const Listening log;
        fake.go();
        size_t fading = 0, other = 0;
        for (const TickRow& row : fake.sink.rows) {
            const bool stale = row.record.sceneAge > kStaleAfter;
            fading += stale && row.record.state == StepState::Fading ? 1 : 0;
            other += stale && row.record.state != StepState::Fading ? 1 : 0;
        }
        CHECK(other == 0);
        CHECK(fading == fake.run->staleTicks());
        CHECK((log.count("ms old: forces fade") > 0) == (fading > 0));
        CHECK((log.count("frames are fresh again") > 0) == (fading > 0));
        CHECK((stall == 0.0 || fading > 0));
    }
}

TEST_CASE("Drill: a camera that stalls forever leaves no force, and the tool still obeys the last regions") {
    const Fade fade = stallCamera(20.0, false);
    CHECK(fade.gone <= 0.61);
    CHECK(fade.deepest < 1e-5);
    CHECK(fade.marked);
}

TEST_CASE(
    "Drill: a clock that jumps, as after a suspended machine, fades or holds the force and never steps it") {
    for (const double leap : {0.05, 5.0, 3600.0, -0.5}) {
        CAPTURE(leap);
        HapticRig rig(handScene(), at(0.0, 0.0, 0.03));
        rig.show(wallSet(1));
        rig.sceneAges = false; // the camera continues
        rig.ticks(10);
        rig.hand = at(0.0, 0.0, 0.0);
        double before = forceOf(rig.ticks(200));
        const double full = before;
        CHECK(full > 5.0);
        rig.sceneAges = true; // the active set was captured before the jump
        rig.time += leap;
        double largestStep = 0.0;
        for (int i = 0; i < 700; ++i) {
            if (i == 50) {
                rig.sceneAges = false;
            }
            const StepRecord record = rig.step();
            CHECK(record.finite);
            largestStep = std::max(largestStep, std::abs(forceOf(record) - before));
            before = forceOf(record);
            CHECK(before <= full + 1e-6);
            CHECK(rig.gap() > -1e-5);
        }
        CHECK(largestStep <= rig.options.slewForce * rig.options.period + 1e-9);
        CHECK(before == doctest::Approx(full).epsilon(0.01)); // the full force is back
    }
}

TEST_CASE("Drill: with every CPU busy no tick penetrates, no force steps or outlives its scene, missed "
          "periods are counted, the end is zero force") {
    std::atomic<bool> done{false};
    std::vector<std::thread> load;
    for (unsigned i = 0; i < 2 * std::max(2u, std::thread::hardware_concurrency()); ++i) {
        load.emplace_back([&done] {
            while (!done.load(std::memory_order_relaxed)) {
            }
        });
    }
    FakeRun fake(45, wipingPath(2.5));
    fake.feed.beforePublish = [](uint32_t index) { // the camera stalls as well, until no force may be left
        if (index == 20) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1000));
        }
    };
    fake.go();
    done.store(true);
    for (std::thread& thread : load) {
        thread.join();
    }
    checkSafeEnd(fake);
    REQUIRE(!fake.sink.rows.empty());
    uint64_t missed = 0;
    for (const TickRow& row : fake.sink.rows) {
        missed += row.missed;
    }
    CHECK(missed == fake.run->periodsMissed());
    CHECK(fake.sink.rows.size() + missed >= 2495); // every period is a tick or is counted as missed
    CHECK(checkFades(fake) > 0);
    MESSAGE("turns " << fake.sink.rows.size() << ", periods without one " << missed);
}

TEST_CASE(
    "Drill: a GPU that is lost or out of memory is opened again while the force fades, and both return") {
    for (const bool lost : {true, false}) {
        FakeRun fake(75, pressingPath(3.0));
        int refusals = 2;
        bool fails = true;
        fake.feed.beforePublish = [&](uint32_t index) {
            if (index == 15 && std::exchange(fails, false)) {
                lost ? throw DeviceLost("VK_ERROR_DEVICE_LOST")
                     : throw OutOfMemory("VK_ERROR_OUT_OF_DEVICE_MEMORY");
            }
        };
        fake.feed.onRenew = [&] {
            if (refusals-- > 0) {
                throw DeviceLost("not there yet");
            }
        };
        fake.go();
        REQUIRE(fake.run->failure() == nullptr);
        CHECK(fake.feed.renewed == 1);
        CHECK(fake.feed.published == 75);
        CHECK(fake.sink.audit.maxPenetration() <= 1e-5);
        // Retries after 0.1, 0.2 and 0.4 s, which takes longer than the fade.
        double least = 1e9, last = 0.0;
        for (const TickRow& row : fake.sink.rows) {
            const double force = glm::length(row.record.wrench.force);
            least = row.record.t > 0.4 ? std::min(least, force) : least;
            last = force;
        }
        CHECK(least == 0.0);
        CHECK(last > 1.0);
    }
}

TEST_CASE(
    "Drill: a GPU lost while the camera is gone is opened again, and the scene ages until a frame comes") {
    FakeRun fake(60, pressingPath(3.0));
    int refusals = 0, renewedAt = -1;
    fake.feed.onRenew = [&] { renewedAt = refusals; };
    fake.feed.beforeFetch = [&](uint32_t index) {
        if (index == 15 && refusals < 4) {
            fake.feed.deviceLost = refusals == 0;
            ++refusals;
            throw DeviceLost("unplugged");
        }
    };
    fake.go();
    REQUIRE(fake.run->failure() == nullptr);
    CHECK(fake.feed.renewed == 1);
    CHECK(renewedAt == 1); // while the camera still failed
    CHECK(fake.feed.published == 60);
    double least = 1e9;
    fake.during(0.5, 2.0, [&](const StepRecord& r) { least = std::min(least, forceOf(r)); });
    CHECK(least < 0.01); // no force while frames are missing, whichever device returns first
}

TEST_CASE("Drill: a GPU that is lost or out of memory and cannot be opened again ends the run with zero "
          "force and the error") {
    const auto drill = [](const std::function<void()>& fault) {
        FakeRun fake(300, pressingPath(10.0));
        fake.feed.beforePublish = [&fault](uint32_t index) {
            if (index == 10) {
                fault();
            }
        };
        fake.go();
        checkSafeEnd(fake);
        REQUIRE(fake.run->failure() != nullptr);
        REQUIRE(!fake.sink.rows.empty());
        CHECK(fake.sink.rows.back().record.t < 8.0);
        return fake.run->failure();
    };
    CHECK_THROWS_AS(std::rethrow_exception(drill([] { throw DeviceLost("VK_ERROR_DEVICE_LOST"); })),
                    DeviceLost);
    CHECK_THROWS_AS(std::rethrow_exception(drill([] { throw OutOfMemory("VK_ERROR_OUT_OF_DEVICE_MEMORY"); })),
                    OutOfMemory);
    CHECK_THROWS_AS(std::rethrow_exception(drill([] { throw std::bad_alloc(); })), std::bad_alloc);
}
