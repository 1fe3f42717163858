// SPDX-License-Identifier: Apache-2.0
// Pressed regions that vanish, at any depth, reach and stiffness: tool and hand stay, the force fades out.
#include "tests/cycle/arm_cycle_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Shows no region any more; the tool must stay, and the force fade out without a step.
void checkStays(HapticRig& rig, StepRecord pressed, double travel) {
    rig.show(emptySet(1000));
    rig.sceneAges = false;
    const dvec3 place = pressed.tool.position;
    double force = forceOf(pressed);
    const double most = 0.012 * force + 0.01;
    for (int i = 0; i < 199; ++i) {
        const StepRecord record = rig.step();
        CHECK(glm::distance(record.tool.position, place) <= travel);
        CHECK(force - forceOf(record) <= most);
        force = forceOf(record);
    }
    const StepRecord after = rig.ticks(5);
    CHECK(after.vanished == 1);
    CHECK(forceOf(after) == doctest::Approx(0.0));
}

// The tool rests on the wall, and the hand is `depth` [m] inside.
StepRecord press(HapticRig& rig, double depth) {
    rig.show(wallSet(1));
    rig.sceneAges = false;
    rig.ticks(300);
    const dvec3 from = rig.hand.position;
    const double way = (rig.step().device.position.z - (0.01 - depth)) / rig.options.handScale;
    for (int i = 1; i <= 2000; ++i) {
        rig.hand.position.z = from.z - way * i / 2000.0;
        rig.step();
    }
    return rig.ticks(200);
}

} // namespace

TEST_CASE("An arm stays where it is when the region vanishes that it presses into, however deep") {
    for (const double depth : {0.004, 0.012, 0.02, 0.04}) {
        CAPTURE(depth);
        ArmCycleRig rig;
        double y = 0.0;
        while (rig.step().contactCount == 0 && y < 0.2) {
            y += 5e-5;
            rig.hand = at(0.0, y, 0.0);
        }
        StepRecord pressed;
        for (int i = 0; i < 1500; ++i) {
            rig.hand = at(0.0, y + depth * std::min(1.0, i / 500.0), 0.0);
            pressed = rig.step();
        }
        REQUIRE(forceOf(pressed) > 2.0);
        checkStays(rig, pressed, 0.003);
    }
}

TEST_CASE("A region that vanishes is noticed whatever the reach of contact queries is") {
    for (const double reach : {0.0005, 0.001, 0.002, 0.02}) {
        CAPTURE(reach);
        HapticRig rig(handScene(), at(0, 0, 0.02));
        rig.reach = reach;
        const StepRecord pressed = press(rig, 0.0045);
        REQUIRE(forceOf(pressed) == doctest::Approx(4.5).epsilon(0.05));
        checkStays(rig, pressed, 0.0003);
    }
}

TEST_CASE("A region that soft springs press into is held fast when it vanishes, too") {
    Scene soft = handScene();
    soft.haptics.stiffness = 20.0;
    HapticRig rig(soft, at(0, 0, 0.02));
    const StepRecord pressed = press(rig, 0.024);
    REQUIRE(forceOf(pressed) == doctest::Approx(0.48).epsilon(0.05));
    checkStays(rig, pressed, 0.0003);
}

TEST_CASE("A coarse hand map makes soft springs, and a vanished region still holds tool and hand") {
    Scene coarse = handScene();
    coarse.hand.scale = 20.0;
    HapticRig rig(coarse, at(0, 0, 0.02));
    const StepRecord pressed = press(rig, 0.009);
    REQUIRE(glm::distance(pressed.device.position, pressed.tool.position) > 0.008);
    checkStays(rig, pressed, 0.0003);
}

TEST_CASE("A tool that a squeezed picture trapped stays where it is when all regions vanish") {
    HapticRig rig(handScene(), at(0, 0, 0.02));
    press(rig, 0.01);
    HostFixtures squeezed = wallSet(2);
    addWall(squeezed, {0, 0, 0.06}, {1, 0, 0}, {0, 1, 0}, 0.06, 0.004, 0.042);
    rig.show(squeezed);
    rig.sceneAges = false;
    const StepRecord trapped = rig.ticks(33);
    REQUIRE(trapped.state == StepState::Trapped);
    checkStays(rig, trapped, 0.0003);
}

TEST_CASE("A hand that leaves a trapped tool has not lost a region when the trap ends") {
    HapticRig rig(handScene(), at(0, 0, 0.02));
    press(rig, 0.01);
    HostFixtures squeezed = wallSet(2);
    addWall(squeezed, {0, 0, 0.06}, {1, 0, 0}, {0, 1, 0}, 0.06, 0.004, 0.042);
    rig.show(squeezed);
    rig.sceneAges = false;
    REQUIRE(rig.ticks(33).state == StepState::Trapped);
    for (int i = 0; i < 300; ++i) {
        rig.hand.position.z += 1e-4; // to 20 mm in front of the wall
        rig.step();
    }
    StepRecord record = rig.step();
    REQUIRE(record.state == StepState::Trapped);
    rig.show(wallSet(3));
    rig.sceneAges = false;
    dvec3 before = record.tool.position;
    for (int i = 0; i < 300; ++i) {
        record = rig.step();
        CHECK(glm::distance(record.tool.position, before) <= 0.0003);
        before = record.tool.position;
    }
    CHECK(record.vanished == 0);
    CHECK(glm::distance(before, record.device.position) <= 0.001);
}

TEST_CASE("A wall that goes back by up to 8 mm under a lightly pressing hand has not vanished") {
    for (const double pressed : {0.0015, 0.0029}) {
        for (const double back : {0.004, 0.006, 0.0075}) {
            CAPTURE(pressed);
            CAPTURE(back);
            HapticRig rig(handScene(), at(0, 0, 0.02));
            REQUIRE(forceOf(press(rig, pressed)) == doctest::Approx(1000.0 * pressed).epsilon(0.1));
            HostFixtures moved = emptySet(2);
            addWall(moved, {0.0, 0.0, -0.04 - back}, {1, 0, 0}, {0, 1, 0}, 0.06, 0.004, 0.04);
            rig.show(std::move(moved));
            rig.sceneAges = false;
            const StepRecord after = rig.ticks(100);
            CHECK(after.vanished == 0);
            CHECK(forceOf(after) == 0.0);
            CHECK(glm::distance(after.tool.position, rig.hand.position) < 1e-6);
        }
    }
}

TEST_CASE("Another class behind a pressed region does not hide that the region vanished") {
    HapticRig rig(handScene(), at(0, 0, 0.02));
    REQUIRE(forceOf(press(rig, 0.006)) == doctest::Approx(6.0).epsilon(0.05));
    HostFixtures other = emptySet(2);
    addWall(other, {0.0, 0.0, -0.0475}, {1, 0, 0}, {0, 1, 0}, 0.06, 0.004, 0.04);
    std::ranges::fill(other.spheres.fixture, uint8_t{1});
    rig.show(std::move(other));
    rig.sceneAges = false;
    CHECK(rig.ticks(300).vanished == 1);
}

TEST_CASE("With stiff springs a wall that goes back while another region presses has not vanished") {
    HapticRig rig(handScene("omega"), at(0, 0, 0.02));
    const auto show = [&](double back, uint64_t generation) {
        HostFixtures set = emptySet(generation);
        addWall(set, {0.0, 0.0, -0.04 - back}, {1, 0, 0}, {0, 1, 0}, 0.06, 0.004, 0.04);
        set.spheres.add({0.0, 0.0597, 0.01}, 0.05); // next to the tool, 0.3 mm inside
        rig.show(std::move(set));
        rig.sceneAges = false;
    };
    show(0.0, 1);
    rig.ticks(300);
    rig.hand = at(0, 0, 0.0076);
    const StepRecord pressed = rig.ticks(1000);
    REQUIRE(pressed.wrench.force.z > 10.0);
    REQUIRE(pressed.wrench.force.y < -0.5);
    show(0.0025, 2);
    double before = pressed.wrench.force.z;
    for (int i = 0; i < 300; ++i) {
        const StepRecord record = rig.step();
        CHECK(before - record.wrench.force.z < 0.15); // no blow
        CHECK(record.wrench.force.y == doctest::Approx(pressed.wrench.force.y).epsilon(0.1));
        CHECK(record.vanished == 0);
        before = record.wrench.force.z;
    }
}
