// SPDX-License-Identifier: Apache-2.0
// The haptic cycle with a real arm: the pilot's tool when that arm stands still.
#include "engine/cycle/haptic_cycle.h"

#include "tests/cycle/arm_cycle_rig.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

namespace {

// An arm that a real one follows.
ArmCycleRig followedArm(const StretchedArm& wanted = {}) {
    ArmCycleRig follow(wanted);
    follow.realArm = ArmFollow{true, true, {}};
    return follow;
}

// Moves until the ball stops the tool and the hand is 5 mm farther.
ArmCycleRig pressed() {
    ArmCycleRig follow = followedArm();
    follow.ticks(5);
    for (int i = 0; i < 400; ++i) {
        follow.hand.position.y += 0.0002;
        follow.step();
    }
    return follow;
}

} // namespace

TEST_CASE("An arm that follows moves like the tool, and the pilot feels obstacles") {
    ArmCycleRig follow = pressed();
    const StepRecord record = follow.ticks(50);
    CHECK(record.state == StepState::Contact);
    CHECK(forceOf(record) > 2.0);
    CHECK_FALSE(record.armHold);
    CHECK_FALSE(follow.placed);
    CHECK(follow.gap() >= -1e-9);
}

TEST_CASE("Without contact an arm at the limits of its joints is free, and one that is too slow waits") {
    ArmCycleRig follow = followedArm({.limit = 0.1}); // the tip reaches 0.15 m to the side
    follow.ticks(5);
    uint32_t pushed = 0, waits = 0;
    for (int i = 0; i < 1500; ++i) {
        const double step = i < 700 ? 0.0003 : 0.0;
        follow.hand.position.y -= i == 100 ? 0.05 : step; // no joint follows such a jump at once
        const StepRecord record = follow.step();
        REQUIRE(record.contactCount == 0);
        CHECK(record.state != StepState::Contact);
        const bool pushes = (record.cause & cause::kJoint) != 0 && forceOf(record) > 0.0;
        CHECK((!pushes || record.state == StepState::Free));
        pushed += pushes ? 1 : 0;
        waits += record.state == StepState::Waiting ? 1 : 0;
    }
    CHECK(pushed > 100);
    CHECK(waits > 10);
}

TEST_CASE("An arm that stands still holds the tool at once, and the force is gone after 0.2 s") {
    for (const int why : {0, 1}) {
        ArmCycleRig follow = pressed();
        const double full = forceOf(follow.ticks(50));
        const ArmPosture before = follow.cycle->place().arm;
        (why == 0 ? follow.realArm->follows = false : (follow.buttons = kDeadManOpen) != 0);
        follow.realArm->known = false; // also without feedback
        double last = full;
        for (int i = 0; i < 400; ++i) {
            follow.hand.position += dvec3(0.0005, 0.0005, 0.0);
            const StepRecord record = follow.step();
            CHECK(record.armHold);
            CHECK(record.state == (i < 198 ? StepState::Fading : i > 202 ? StepState::Off : record.state));
            CHECK(record.arm.posture.q == before.q);
            CHECK(forceOf(record) <= last + 1e-12);
            CHECK(last - forceOf(record) < 0.05 * full);      // no jump
            CHECK(glm::length(record.wrench.torque) < 1e-12); // the tool's direction stays free
            last = forceOf(record);
        }
        CHECK(last == 0.0);
    }
}

TEST_CASE("Forces off hold an arm that follows, and it does not jump to a hand that moved elsewhere") {
    ArmCycleRig follow = pressed();
    follow.ticks(50);
    follow.realArm->posture = follow.cycle->place().arm;
    follow.buttons = kDeadManOpen;
    follow.ticks(300);
    follow.hand.position += dvec3(-0.2, -0.3, 0.1);
    CHECK(follow.ticks(10).armHold);
    const Pose tool = follow.cycle->pose();
    follow.buttons = 0;
    const StepRecord record = follow.ticks(300);
    CHECK_FALSE(record.armHold);
    CHECK(glm::distance(record.tool.position, tool.position) < 1e-6);
    CHECK(forceOf(record) < 1e-3);
    follow.hand.position.y -= 0.005; // from here on the tool follows the hand
    CHECK(glm::distance(follow.ticks(200).tool.position, tool.position) ==
          doctest::Approx(0.005).epsilon(0.02));
}

TEST_CASE(
    "The tool resumes from the arm's measured posture, also inside a region, and only moves out of it") {
    ArmCycleRig follow = pressed();
    follow.realArm->posture = follow.cycle->place().arm;
    follow.realArm->posture.q[0] += 0.01; // the arm's own lag carried its links 5 to 10 mm into the ball
    follow.realArm->follows = false;
    follow.ticks(300);
    CHECK(follow.placed);
    CHECK(follow.cycle->place().arm.q == follow.realArm->posture.q);
    double deepest = -follow.gap();
    CHECK(deepest > 0.004);
    follow.realArm->follows = true;
    for (int i = 0; i < 500; ++i) {
        const StepRecord record = follow.step();
        CHECK(-follow.gap() <= deepest + 1e-9);
        CHECK(forceOf(record) < 20.0);
        deepest = std::max(0.0, -follow.gap());
    }
    CHECK(deepest < 1e-6);
}

TEST_CASE("A tool placed far from known contacts waits until contacts are known there") {
    ArmCycleRig follow = pressed();
    follow.realArm = ArmFollow{false, true, follow.cycle->place().arm};
    follow.ticks(300);
    CHECK(follow.placed);
    follow.realArm->posture.q = {-0.6, 0.3, 0.2, -0.1}; // contacts are known only near the old place
    follow.realArm->follows = true;
    const StepRecord first = follow.step();
    CHECK_FALSE(first.adopted);
    CHECK(first.armHold);
    CHECK(first.arm.posture.q == follow.realArm->posture.q);
    const StepRecord then = follow.ticks(3);
    CHECK(follow.contacts.active() != nullptr);
    CHECK_FALSE(then.armHold);
}

TEST_CASE("A measured posture that is not finite or beyond the limits leaves the tool inside them") {
    ArmCycleRig follow = pressed();
    const ArmPosture before = follow.cycle->place().arm;
    follow.realArm = ArmFollow{false, true, {}};
    follow.realArm->posture.q = {kNotKnown, 9.0, -9.0, 0.1};
    follow.ticks(300);
    const ArmPosture now = follow.cycle->place().arm;
    CHECK(now.q == JointVector{before.q[0], 1.2, -1.2, 0.1});
}
