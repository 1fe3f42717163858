// SPDX-License-Identifier: Apache-2.0
// The rules of a haptic step: start, contact, forces off, dead-man, clutch, trapped, old scene, non-finite
// numbers.
#include "tests/cycle/haptic_rig.h"

#include "engine/haptics/limits.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

static_assert(noexcept(std::declval<HapticCycle&>().step(std::declval<const StepInput&>())));

TEST_CASE("Until the first contact set the tool is held, the wrench is zero and the state is off") {
    HapticRig rig(handScene(), at(0, 0, 0.05));
    rig.hand = at(0, 0, -0.05);
    for (int i = 0; i < 300; ++i) {
        const auto record = rig.step();
        CHECK(record.state == StepState::Off);
        CHECK(record.tool.position == dvec3(0, 0, 0.05));
        CHECK(record.device.position == dvec3(0, 0, -0.05));
        CHECK(forceOf(record) == 0.0);
        CHECK(record.frame == -1);
        CHECK(std::isnan(record.sceneAge));
        CHECK(record.contactCount == 0);
        CHECK(record.armHold);
    }
    rig.hand = at(0, 0, 0.05);
    rig.show(wallSet(7));
    const auto record = rig.step();
    CHECK(record.adopted);
    CHECK(record.frame == 7);
    CHECK(record.state == StepState::Free);
    CHECK(record.minGap == rig.contacts.active()->reach); // nothing is nearer than the reach of the query
}

TEST_CASE("In free space the tool equals the hand to the last bit and there is no force") {
    HapticRig rig(handScene(), at(0, 0.01, 0.05));
    rig.show(wallSet());
    for (int i = 0; i < 200; ++i) {
        rig.hand = {{0.02 * std::sin(0.03 * i), 0.01 * std::cos(0.05 * i), 0.05},
                    rotationExp({0.0, 0.01 * i, 0.1})};
        rig.scene.captureTime = rig.time;
        const auto record = rig.step();
        CHECK(record.state == StepState::Free);
        CHECK(record.tool.position == record.device.position);
        CHECK(forceOf(record) <= 1e-12);
        CHECK(record.sceneAge == 0.0);
        CHECK_FALSE(record.stalled);
        CHECK(record.deviceWrench.force == record.wrench.force);
    }
}

TEST_CASE("Pressed into a wall the tool stays outside and the hand feels K times the distance") {
    auto rig = pressedRig();
    const auto record = rig.step();
    CHECK(record.state == StepState::Contact);
    CHECK(record.contactCount >= 1);
    CHECK(rig.gap() >= 0.0);
    CHECK(rig.gap() <= 1e-6);
    CHECK(record.minGap == doctest::Approx(rig.gap()).epsilon(1e-6));
    CHECK(glm::distance(record.wrench.force, 1000.0 * (record.tool.position - record.device.position)) <=
          1e-9);
    CHECK(record.wrench.force.z == doctest::Approx(5.0).epsilon(0.05));
    CHECK(record.marginPassive == doctest::Approx(0.0));
    CHECK(record.marginUncoupled == doctest::Approx(0.0));
    CHECK_FALSE(record.armHold); // released while tool and hand were together
}

TEST_CASE("Force and its change stay within their limits however the hand jumps, and no leaf ever enters a "
          "region") {
    HapticRig rig(handScene(), at(0, 0, 0.02));
    rig.show(wallSet());
    rig.sceneAges = false;
    dvec3 before(0.0);
    double largest = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const int step = i / 150, otherStep = i / 210;
        rig.hand = at(0.03 * std::sin(0.5 * step), 0.02 * std::cos(0.9 * otherStep),
                      i / 300 % 2 == 0 ? -0.08 : 0.03);
        const auto record = rig.step();
        CHECK(glm::distance(record.wrench.force, before) <= 2.0 * (1.0 + 1e-12));
        CHECK(forceOf(record) <= 20.0 * (1.0 + 1e-12));
        CHECK(glm::length(record.wrench.torque) <= 2.0);
        CHECK(rig.gap() >= 0.0);
        before = record.wrench.force;
        largest = std::max(largest, forceOf(record));
    }
    CHECK(largest == doctest::Approx(20.0));
}

TEST_CASE(
    "With forces off guidance and wrench are gone after 0.2 s, and the tool follows and still obeys the "
    "wall") {
    for (const bool deadMan : {false, true}) {
        auto rig = pressedRig();
        GuidancePose target;
        target.present = target.planar = true;
        target.target = at(0.01, 0, 0.011);
        rig.guidance = {target};
        rig.buttons = kGuidanceButton;
        rig.ticks(600);
        REQUIRE(rig.step().guidance == 1.0);
        rig.buttons |= deadMan ? kDeadManOpen : 0u;
        rig.forcesOff = !deadMan;
        const double start = forceOf(rig.ticks(1));
        auto record = rig.step();
        CHECK(record.state == StepState::Fading);
        CHECK(start > 3.0);
        rig.ticks(97);
        CHECK(forceOf(rig.step()) == doctest::Approx(2.5).epsilon(0.06)); // halfway through the ramp
        rig.ticks(100);
        record = rig.step();
        CHECK(forceOf(record) <= 1e-12);
        CHECK(record.guidance == 0.0);
        CHECK(record.state == StepState::Off);
        CHECK(record.armHold);
        rig.hand = at(0.02, 0.01, -0.03); // to the side and deep inside
        rig.ticks(200);
        record = rig.step();
        CHECK(forceOf(record) == 0.0);
        CHECK(rig.gap() >= 0.0);
        CHECK(record.tool.position.x == doctest::Approx(0.02).epsilon(0.1));
        rig.forcesOff = false;
        rig.buttons = 0;
        double before = 0.0;
        for (int i = 0; i < 250; ++i) {
            const double now = forceOf(rig.step());
            CHECK(now - before <= 2.0);
            before = now;
        }
        CHECK(before == doctest::Approx(20.0).epsilon(1e-6)); // 40 mm inside: at the limit again
    }
}

TEST_CASE(
    "The clutch holds the device pose and ramps the force out; then the force returns by its limit, without "
    "a jump") {
    auto rig = pressedRig();
    const auto held = rig.step();
    rig.buttons = 4;
    for (int i = 0; i < 300; ++i) {
        rig.hand = at(0.0, 0.0, 0.005 + 0.0005 * i);
        const auto record = rig.step();
        CHECK(record.device.position == held.device.position);
        CHECK(glm::distance(record.tool.position, held.tool.position) <= 1e-8);
        CHECK(forceOf(record) <= std::max(0.0, 5.0 * (1.0 - (i + 1) / 200.0)) * 1.05 + 1e-9);
    }
    rig.buttons = 0;
    auto record = rig.step();
    CHECK(glm::distance(record.device.position, held.device.position) <= 1e-12);
    rig.ticks(19);
    CHECK(forceOf(rig.step()) == doctest::Approx(20.0 * 0.105).epsilon(1e-6)); // 20 N in 0.2 s
    rig.ticks(40);
    CHECK(forceOf(rig.step()) == doctest::Approx(forceOf(held)).epsilon(1e-6));
}

TEST_CASE("A trapped tool is held without a new force, and follows slowly when a motion is found") {
    HapticRig rig(handScene(), at(0, 0, 0));
    rig.show(emptySet(1));
    rig.sceneAges = false;
    rig.hand = at(0, 0, 0.003);
    rig.ticks(250);
    HostFixtures shell = emptySet(2); // six spheres around the tool: any motion goes deeper into one
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            dvec3 centre(0, 0, 0.003);
            centre[axis] += side * 0.035;
            shell.spheres.add(centre, 0.03);
        }
    }
    const Pose where = rig.cycle->pose();
    rig.show(shell);
    rig.sceneAges = false;
    rig.hand = at(0, 0, 0.013);
    auto record = rig.step();
    CHECK(record.state == StepState::Trapped);
    CHECK(forceOf(record) == 0.0); // a trap has no force of its own
    CHECK(record.infeasible >= 1);
    CHECK(record.armHold);
    rig.ticks(99);
    record = rig.step();
    CHECK(record.tool.position == where.position);
    CHECK(forceOf(record) == 0.0);
    record = rig.ticks(120);
    CHECK(record.state == StepState::Trapped);
    rig.show(emptySet(3));
    rig.sceneAges = false;
    record = rig.step();
    CHECK(record.state == StepState::Waiting); // the tool follows at 0.2 m/s, without a force
    CHECK(forceOf(record) == 0.0);
    record = rig.ticks(250);
    CHECK(record.state == StepState::Free);
    CHECK(glm::distance(record.tool.position, record.device.position) <= 1e-12);
}

TEST_CASE("A scene older than 100 ms fades the force over half a second, sets the state, and a fresh frame "
          "restores the force") {
    auto rig = pressedRig();
    const double full = forceOf(rig.step());
    rig.sceneAges = true;
    rig.scene.captureTime = rig.time;
    auto record = rig.ticks(100);
    CHECK(record.state == StepState::Contact);
    CHECK(forceOf(record) == doctest::Approx(full));
    record = rig.ticks(252);
    CHECK(record.state == StepState::Fading);
    CHECK(record.sceneAge == doctest::Approx(0.351));
    CHECK(forceOf(record) == doctest::Approx(full / 2.0).epsilon(0.01));
    CHECK(record.armHold);
    record = rig.ticks(260);
    CHECK(forceOf(record) <= 1e-12);
    CHECK(record.state == StepState::Fading);
    rig.scene.captureTime = rig.time; // the same frame again: only a new capture time
    record = rig.step();
    CHECK(record.state == StepState::Contact);
    rig.sceneAges = false;
    record = rig.ticks(510);
    CHECK(forceOf(record) == doctest::Approx(full));
}

TEST_CASE("A source that has ended does not age in lockstep, and an older active set ages by its own stamp") {
    auto rig = pressedRig();
    rig.sceneAges = true;
    rig.scene.captureTime = rig.time;
    rig.ticks(31);
    rig.scene.sourceEnded = true;
    auto record = rig.ticks(3000);
    CHECK(record.state == StepState::Contact);
    CHECK(record.sceneAge == doctest::Approx(0.030));
    // The active set stays at frame 1 although frame 2 is available, captured later.
    rig.scene.sourceEnded = false;
    rig.query = false;
    HostFixtures next = wallSet(2);
    next.captureTime = rig.time;
    rig.show(next);
    record = rig.step();
    CHECK(record.frame == 1);
    CHECK(record.sceneAge == doctest::Approx(rig.time - rig.options.period)); // stamped 0 in this rig
    rig.query = true;
    record = rig.step();
    CHECK(record.frame == 2);
    CHECK(record.sceneAge == doctest::Approx(0.001));
}

TEST_CASE(
    "A sample that is not finite gives a zero wrench in that tick, is counted, and does no lasting harm") {
    auto rig = pressedRig();
    const double full = forceOf(rig.step());
    const Pose good = rig.hand;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const Pose& bad :
         {Pose{{0.0, nan, 0.0}, good.rotation}, Pose{{0.0, infinite, 0.0}, good.rotation},
          Pose{good.position, {1.0, nan, 0.0, 0.0}}, Pose{good.position, {1.0, 0.0, infinite, 0.0}}}) {
        const uint64_t before = rig.cycle->notFinite();
        rig.hand = bad;
        auto record = rig.step();
        CHECK_FALSE(record.finite);
        CHECK(forceOf(record) == 0.0);
        CHECK(glm::length(record.deviceWrench.force) == 0.0);
        CHECK(isFinite(record.device));
        CHECK(isFinite(record.tool));
        CHECK(rig.cycle->notFinite() == before + 1);
        rig.hand = good;
        record = rig.step();
        CHECK(record.finite);
        CHECK(forceOf(record) == doctest::Approx(0.1)); // the limit of 20 N rises from zero in 0.2 s
        CHECK(forceOf(rig.ticks(60)) == doctest::Approx(full));
    }
}

TEST_CASE("A rotation of zeros or without a length does no lasting harm") {
    for (const dquat& none :
         {dquat(0.0, 0.0, 0.0, 0.0), dquat(1e200, 0.0, 1e200, 0.0), dquat(1e-200, 0.0, 0.0, 0.0)}) {
        auto rig = pressedRig();
        const double full = forceOf(rig.step());
        const Pose good = rig.hand;
        rig.hand.rotation = none;
        for (int i = 0; i < 10; ++i) {
            const auto record = rig.step();
            CHECK(isFinite(record.wrench));
            CHECK(isFinite(record.deviceWrench));
            CHECK(isFinite(record.tool));
        }
        rig.hand = good;
        CHECK(forceOf(rig.ticks(60)) == doctest::Approx(full));
        CHECK(rig.gap() > -1e-5);
    }
}
