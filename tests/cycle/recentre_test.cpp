// SPDX-License-Identifier: Apache-2.0
// The clutch with forces off, and how steeply forces come back.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("With forces off the clutch brings the hand to the tool, which stays, and forces return without a "
          "push") {
    auto rig = pressedRig();
    rig.hand = {{0.0, 0.0, -0.05}, glm::angleAxis(0.4, dvec3(1, 0, 0))};
    rig.forcesOff = true;
    rig.ticks(150);
    rig.buttons = rig.options.clutchBit; // while the force fades, nothing moves
    const StepRecord fading = rig.ticks(2);
    CHECK(forceOf(fading) > 0.1);
    CHECK(glm::distance(fading.device.position, fading.tool.position) > 0.05);
    rig.buttons = 0;
    const StepRecord apart = rig.ticks(300);
    REQUIRE(apart.state == StepState::Off);
    REQUIRE(glm::distance(apart.device.position, apart.tool.position) > 0.05);
    rig.buttons = rig.options.clutchBit;
    const StepRecord centred = rig.ticks(3);
    CHECK(glm::distance(centred.device.position, centred.tool.position) < 1e-6);
    CHECK(std::abs(glm::dot(centred.device.rotation, centred.tool.rotation)) > 1.0 - 1e-9);
    CHECK(glm::distance(centred.tool.position, apart.tool.position) < 1e-4);
    rig.buttons = 0;
    rig.forcesOff = false;
    double most = 0.0;
    for (int i = 0; i < 500; ++i) {
        most = std::max(most, forceOf(rig.step()));
    }
    CHECK(most < 0.2);
    rig.hand.position.z += 0.02; // the hand leads the tool again, from where it was
    const StepRecord moved = rig.ticks(100);
    CHECK(moved.tool.position.z == doctest::Approx(centred.tool.position.z + 0.02).epsilon(0.01));
}

TEST_CASE("With forces on the clutch keeps the pose that the hand commands") {
    auto rig = pressedRig();
    const StepRecord before = rig.step();
    rig.buttons = rig.options.clutchBit;
    const StepRecord clutched = rig.ticks(400);
    CHECK(clutched.device.position == before.device.position);
}

TEST_CASE("Forces that return to a hand pressed deep into a region rise evenly, at most as the time says") {
    auto rig = pressedRig();
    rig.options.forceLimit = 40.0;
    rig.options.softStartTime = 2.0;
    rig.restart();
    rig.hand = at(0, 0, 0.02);
    rig.ticks(50);
    rig.hand = at(0, 0, -0.05); // 60 N at 1000 N/m
    rig.forcesOff = true;
    REQUIRE(forceOf(rig.ticks(400)) == 0.0);
    rig.forcesOff = false;
    double before = 0.0, steepest = 0.0;
    int ticks = 0;
    for (; ticks < 3000 && before < 39.9; ++ticks) {
        const double force = forceOf(rig.step());
        steepest = std::max(steepest, force - before);
        before = force;
    }
    CHECK(steepest <= 0.0201); // 20 N/s
    CHECK(ticks > 1950);
    CHECK(ticks < 2100);
}
