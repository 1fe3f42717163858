// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/arm_follower.h"

#include "engine/run/haptic_loop.h"

#include <cmath>
#include <doctest/doctest.h>
#include <thread>

#include "tests/haptics/arm_proxy_world.h"
#include "tests/realtime/fake_scene.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Reaches every commanded position at once, unless `stuck`.
struct FakeArm final : ArmDevice {
    ArmFeedback state;
    ArmCommand last;
    bool stuck = false;
    int resets = 0;

    FakeArm() {
        state.homed = true;
        state.stale = state.holding = false;
        state.age = 0.01;
    }
    void step(double, const ArmCommand& command) noexcept override {
        last = command;
        if (!command.hold && !stuck) {
            state.position = command.position;
        }
    }
    const ArmFeedback& feedback() const noexcept override { return state; }
    void reset() noexcept override {
        ++resets;
        state.overloaded = false;
    }
};

ArmAxes threeAxes() {
    ArmAxes axes;
    axes.joints = {{2, -1.0, 0.5}, {0, 1.0, 0.0}, {1, 1.0, -0.25}};
    axes.jaws = ArmAxes::Jaws{4, 0.02, 0.0};
    return axes;
}

ArmSetpoint setpoint(double a, double b, double c, double grasp = 0.0) {
    ArmSetpoint w;
    w.posture.q = {a, b, c};
    w.posture.grasp = grasp;
    w.hold = w.off = false;
    return w;
}

} // namespace

TEST_CASE("Joints map to axes and back, by sign and zero, and the grasp maps to the travel of the jaws") {
    FakeArm arm;
    ArmFollower follower(arm, threeAxes());
    const ArmStatus status = follower.exchange(1.0, setpoint(0.1, 0.2, 0.3, 0.25), 0.0);
    CHECK(status.state == ArmState::Follows);
    CHECK(arm.state.position[2] == doctest::Approx(0.4));
    CHECK(arm.state.position[0] == doctest::Approx(0.2));
    CHECK(arm.state.position[1] == doctest::Approx(0.55));
    CHECK(arm.state.position[4] == doctest::Approx(0.015));
    CHECK(status.posture.q[0] == doctest::Approx(0.1));
    CHECK(status.posture.q[2] == doctest::Approx(0.3));
    CHECK(status.posture.grasp == doctest::Approx(0.25));
    CHECK(status.lag < 1e-9);
}

TEST_CASE("An arm without driven jaws reports no grasp, and its jaws stay where they are") {
    FakeArm arm;
    arm.state.position[4] = 0.011;
    ArmAxes axes = threeAxes();
    axes.jaws.reset();
    ArmFollower follower(arm, axes);
    ArmSetpoint hold = setpoint(0, 0, 0);
    hold.hold = true;
    follower.exchange(1.0, hold, 0.0);
    CHECK(std::isnan(follower.exchange(1.1, setpoint(0, 0, 0, 1.0), 0.0).posture.grasp));
    CHECK(arm.state.position[4] == 0.011);
}

TEST_CASE("The arm holds on command, when the setpoint is old and while its positions are not valid") {
    FakeArm arm;
    ArmFollower follower(arm, threeAxes());
    ArmSetpoint held = setpoint(1, 1, 1);
    held.hold = true;
    CHECK(follower.exchange(1.0, held, 0.0).state == ArmState::Held);
    CHECK(arm.last.hold);
    CHECK(follower.exchange(1.1, setpoint(1, 1, 1), 0.2).state == ArmState::Held);
    CHECK(arm.last.hold);
    arm.state.homed = false; // lost during a run, when the arm is never homed
    const ArmStatus lost = follower.exchange(1.2, setpoint(1, 1, 1), 0.0);
    CHECK(lost.state == ArmState::NotHomed);
    CHECK_FALSE(lost.known);
    CHECK(arm.last.hold);
    arm.state.homed = true;
    arm.state.stale = true;
    CHECK(follower.exchange(1.3, setpoint(1, 1, 1), 0.0).state == ArmState::Silent);
    arm.state.stale = false;
    CHECK(follower.exchange(1.4, setpoint(0, 0, 0), 0.0).state == ArmState::Follows);
    CHECK_FALSE(arm.last.hold);
}

TEST_CASE("A motor that drew too much holds until forces are off") {
    FakeArm arm;
    ArmFollower follower(arm, threeAxes());
    arm.state.overloaded = true;
    CHECK(follower.exchange(1.0, setpoint(0, 0, 0), 0.0).state == ArmState::Overloaded);
    CHECK(arm.resets == 0);
    ArmSetpoint off = setpoint(0, 0, 0);
    off.off = off.hold = true;
    CHECK(follower.exchange(1.1, off, 0.0).state == ArmState::Held);
    CHECK(arm.resets == 1);
}

TEST_CASE("An arm that stays far behind is held until the tool is where it is") {
    FakeArm arm;
    ArmFollower follower(arm, threeAxes());
    follower.exchange(1.0, setpoint(0, 0, 0), 0.0);
    arm.stuck = true;
    ArmState state = ArmState::Follows;
    double heldAt = 0.0;
    for (double now = 1.0; now < 2.0; now += 0.01) { // lags by 0.5 rad, more than the allowed 0.35
        state = follower.exchange(now, setpoint(0.5, 0, 0), 0.0).state;
        heldAt = heldAt == 0.0 && state == ArmState::Behind ? now : heldAt;
    }
    CHECK(heldAt == doctest::Approx(1.0 + ArmFollower::kBehindTime).epsilon(0.03));
    CHECK(state == ArmState::Behind);
    CHECK(arm.last.hold);
    arm.stuck = false;
    CHECK(follower.exchange(2.0, setpoint(0.2, 0, 0), 0.0).state == ArmState::Behind); // not close enough yet
    follower.exchange(2.1, setpoint(0.05, 0, 0), 0.0);
    CHECK(follower.exchange(2.2, setpoint(0.05, 0, 0), 0.0).state == ArmState::Follows);
}

TEST_CASE("The haptic tick sends its posture as the setpoint of a real arm, and holds when the arm's thread "
          "stops") {
    FakeRun fake(2, pressingPath(1.0));
    ArmSetup setup;
    setup.model = makeArm(4, 4);
    setup.freeDirection = true;
    HapticOptions options = fake.options;
    options.needsContacts = false;
    const Pose start = at(0, 0, 0);
    HapticCycle cycle(fake.tool, {}, options, start, &start, &setup);
    Channels channels(4096);
    ArmLink link;
    channels.arm = &link;
    RunClock clock;
    HapticLoop loop(cycle, fake.hand, channels, clock, {}, nullptr);
    TickRow row;
    for (int i = 0; i < 40; ++i) {
        link.status.back().state = ArmState::Held;
        link.status.back().known = true;
        link.status.back().posture = cycle.place().arm;
        link.status.back().at = clock.timeAt(clock.now());
        link.status.publish();
        loop.step(clock.now());
        REQUIRE(channels.ticks.pop(row));
    }
    CHECK(row.driven);
    CHECK_FALSE(row.record.armHold);
    REQUIRE(link.setpoint.refresh());
    CHECK_FALSE(link.setpoint.front().hold);
    CHECK(link.setpoint.front().posture.q == row.record.arm.posture.q);
    std::this_thread::sleep_for(std::chrono::milliseconds(150)); // no update from the arm's thread
    loop.step(clock.now());
    REQUIRE(channels.ticks.pop(row));
    CHECK(row.armStatus.state == ArmState::Silent);
    CHECK(row.record.armHold);
    REQUIRE(link.setpoint.refresh());
    CHECK(link.setpoint.front().hold);
}
