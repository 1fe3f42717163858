// SPDX-License-Identifier: Apache-2.0
// What a haptic loop tells the arm, and what it does with ticks that it missed; signals during a run and
// locked memory after it.
#include "engine/run/haptic_loop.h"
#include "engine/types/error.h"

#include <csignal>
#include <doctest/doctest.h>
#include <optional>
#include <thread>
#include <unistd.h>

#include "tests/haptics/arm_proxy_world.h"
#include "tests/realtime/fake_scene.h"
#include "tests/support/locked_memory.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// A loop with an arm of four joints, without regions.
struct ArmLoop {
    FakeRun fake{2, pressingPath(1.0)};
    ArmSetup setup;
    Pose start = at(0, 0, 0);
    HapticCycle cycle;
    Channels channels{4096};
    ArmLink link;
    RunClock clock;
    HapticLoop loop;

    explicit ArmLoop(double seconds)
        : setup(madeSetup())
        , cycle(fake.tool, {}, options(), start, &start, &setup)
        , loop(cycle, fake.hand, channels, clock, {seconds, 0.0}, nullptr) {
        channels.arm = &link;
        channels.scene.back().live = true; // no end of the frames to wait for
        channels.scene.publish();
    }
    static ArmSetup madeSetup() {
        ArmSetup setup;
        setup.model = makeArm(4, 4);
        setup.freeDirection = true;
        return setup;
    }
    HapticOptions options() const {
        HapticOptions options = fake.options;
        options.needsContacts = false;
        return options;
    }
    void run() {
        const std::atomic<bool> stop{false};
        clock.start(0.0);
        loop.run(stop, stop);
    }
};

} // namespace

TEST_CASE("At the end of a run the arm is commanded to hold and to clear its faults") {
    ArmLoop arm(0.03);
    arm.run();
    REQUIRE(arm.link.setpoint.refresh());
    CHECK(arm.link.setpoint.front().hold);
    CHECK(arm.link.setpoint.front().off);
    CHECK(arm.fake.hand.last.force == dvec3(0.0));
}

TEST_CASE("Each setpoint of the arm states whether the dead-man switch is open") {
    ArmLoop arm(1.0);
    for (const bool open : {true, false, true}) {
        arm.fake.hand.spoil = [open](double, HandSample& sample) {
            sample.buttons = open ? kDeadManOpen : 0;
        };
        arm.loop.step(arm.clock.now());
        REQUIRE(arm.link.setpoint.refresh());
        CHECK(arm.link.setpoint.front().off == open);
    }
}

TEST_CASE("Periods that a late tick overran are skipped, not caught up in a burst") {
    ArmLoop arm(0.06);
    int reads = 0;
    arm.fake.hand.spoil = [&reads](double, HandSample&) {
        if (++reads == 5) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    };
    arm.run();
    CHECK(arm.loop.missed() >= 18);
    CHECK(reads <= 60 - 18);
}

TEST_CASE("The threads of a run leave the program's signals to the thread that started it") {
    const auto takesSignals = [] {
        sigset_t mask;
        ::pthread_sigmask(SIG_BLOCK, nullptr, &mask);
        return ::sigismember(&mask, SIGTERM) == 0;
    };
    FakeRun fake(15, pressingPath(0.5));
    std::atomic<int> ticks{0}, queries{0}, frames{0};
    fake.hand.spoil = [&](double, HandSample&) { ticks += takesSignals() ? 1 : 0; };
    fake.answers.before = [&] { queries += takesSignals() ? 1 : 0; };
    fake.feed.beforePublish = [&](uint32_t index) { frames += index > 0 && takesSignals() ? 1 : 0; };
    int writer = 0;
    fake.sink.onTurn = [&](const TickRow&) { writer += takesSignals() ? 1 : 0; };
    fake.go();
    CHECK(ticks == 0);
    CHECK(queries == 0);
    CHECK(frames == 0);
    CHECK(writer > 0);
    CHECK(takesSignals());
}

TEST_CASE("A run keeps no memory locked after its end, also when its sink fails") {
    for (const bool fails : {true, false}) {
        CAPTURE(fails);
        FakeRun fake(30, pressingPath(0.6));
        std::optional<long> locked; // during the run
        fake.sink.onTurn = [&](const TickRow& row) {
            if (row.record.t > 0.3 && !locked) {
                locked = lockedKiB(::getpid());
                if (fails) {
                    throw Error("disk full");
                }
            }
        };
        if (fails) {
            CHECK_THROWS_WITH_AS(fake.go(), "disk full", Error);
        } else {
            fake.go();
        }
        REQUIRE(locked);
        if (*locked == 0) {
            MESSAGE("SKIPPED: no locked memory is permitted here");
        }
        CHECK(lockedKiB(::getpid()) == 0);
    }
}
