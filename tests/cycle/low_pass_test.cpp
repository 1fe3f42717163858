// SPDX-License-Identifier: Apache-2.0
// Scenes whose filter (haptics.limits.lowpass_hz) or slew limit is far slower than the hand and the ramps.
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// At rest 10 mm deep, after the filter has settled.
HapticRig settledRig(double hz) {
    Scene scene = handScene();
    scene.haptics.lowpassHz = hz;
    scene.haptics.stiffness = 1000.0;
    HapticRig rig = pressedRig(scene);
    rig.hand = at(0, 0, 0.0);
    rig.ticks(static_cast<int>(3000.0 / hz));
    return rig;
}

} // namespace

TEST_CASE("A slow low-pass holds no force in free space for longer than a ramp, and the force has a cause") {
    for (const double hz : {0.1, 1.0, 20.0}) {
        CAPTURE(hz);
        HapticRig rig = settledRig(hz);
        double before = forceOf(rig.step());
        CHECK(before > 8.0);
        rig.hand = at(0, 0, 0.03);
        for (int tick = 0; tick < 200; ++tick) {
            const StepRecord record = rig.step();
            CHECK(forceOf(record) <= before);
            CHECK((forceOf(record) == 0.0 || record.cause != 0));
            before = forceOf(record);
        }
        CHECK(before == 0.0);
    }
}

TEST_CASE(
    "With a slow low-pass an open dead-man switch ramps the force to zero, and none is left for later") {
    for (const double hz : {0.1, 1.0, 20.0}) {
        CAPTURE(hz);
        HapticRig rig = settledRig(hz);
        const double pressed = forceOf(rig.step());
        rig.forcesOff = true;
        double before = pressed;
        for (int tick = 0; tick < 200; ++tick) {
            const double force = forceOf(rig.step());
            CHECK(force <= before);
            before = force;
        }
        const StepRecord off = rig.step();
        CHECK(off.state == StepState::Off);
        CHECK(forceOf(off) == 0.0);
        rig.hand = at(0, 0, 0.2);
        rig.ticks(50);
        rig.forcesOff = false;
        for (int tick = 0; tick < 500; ++tick) {
            CHECK(forceOf(rig.step()) == 0.0);
        }
    }
}

TEST_CASE("A low slew limit slows the rise of a force, and neither its fall nor the dead-man switch") {
    Scene scene = handScene();
    scene.haptics.slewForce = 20.0;
    scene.haptics.slewTorque = 0.2;
    scene.haptics.stiffness = 1000.0;
    for (const bool leaves : {true, false}) {
        HapticRig rig = pressedRig(scene);
        CHECK(forceOf(rig.step()) < 2.5); // after 0.1 s
        rig.hand = at(0, 0, -0.005);
        rig.ticks(800);
        CHECK(forceOf(rig.step()) > 14.0);
        rig.hand.position.z += leaves ? 0.1 : 0.0;
        rig.forcesOff = !leaves;
        rig.ticks(201);
        CHECK(forceOf(rig.step()) == 0.0);
    }
}
