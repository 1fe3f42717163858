// SPDX-License-Identifier: Apache-2.0
// Scenes whose filter (haptics.limits.lowpass_hz) or slew limit is far slower than the hand and the ramps.
#include "engine/types/angle.h"
#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace fathom;
using namespace fathom::testing;

namespace {

// At rest so deep [m], after the filter has settled.
HapticRig settledRig(double hz, double depth) {
    Scene scene = handScene();
    scene.haptics.lowpassHz = hz;
    scene.haptics.stiffness = 1000.0;
    HapticRig rig = pressedRig(scene);
    rig.hand = at(0, 0, 0.01 - depth);
    rig.ticks(static_cast<int>(3000.0 / hz));
    return rig;
}

} // namespace

TEST_CASE("A slow low-pass holds no force in free space for longer than a ramp, and the force has a cause") {
    for (const auto& given :
         {std::pair(0.1, 0.01), std::pair(0.1, 0.1), std::pair(0.5, 0.1), std::pair(1.0, 0.01),
          std::pair(1.0, 0.05), std::pair(20.0, 0.01), std::pair(20.0, 0.1)}) {
        const auto &hz = given.first, &depth = given.second;
        INFO(hz << " Hz, " << depth << " m");
        HapticRig rig = settledRig(hz, depth);
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

TEST_CASE("What guidance alone causes is within its pull, also while a region's force still fades") {
    for (const double hz : {0.0, 3.0}) {
        CAPTURE(hz);
        Scene scene = handScene();
        scene.haptics.lowpassHz = hz;
        scene.haptics.stiffness = 1000.0;
        HapticOptions options = makeHapticOptions(springsAlone(scene), ballTool());
        options.passivityController = false;
        WrenchStage stage(options);
        WrenchInput tick;
        tick.springs = options.springs;
        tick.forcesOn = true;
        tick.pull.force = {1.0, 0.0, 0.0};
        int tails = 0, pulls = 0;
        for (int i = 0; i < 2000; ++i) {
            const bool pressed = i < 1000;
            tick.allowed = at(0.0, 0.0, pressed ? 0.005 : 0.0);
            tick.pushes = pressed ? cause::kRow : 0;
            const WrenchStage::Output out = stage.step(tick);
            const bool more = !pressed && glm::length(out.wrench.force) > 1.0 + 1e-9;
            tails += more ? 1 : 0;
            pulls += out.cause == cause::kGuidance ? 1 : 0;
            CHECK((!more || out.cause != cause::kGuidance));
        }
        CHECK((hz == 0.0 || tails > 20));
        CHECK(pulls > 600);
    }
}

TEST_CASE(
    "With a slow low-pass an open dead-man switch ramps the force to zero, and none is left for later") {
    for (const auto& given :
         {std::pair(0.1, 0.01), std::pair(0.1, 0.1), std::pair(0.5, 0.1), std::pair(1.0, 0.01),
          std::pair(1.0, 0.05), std::pair(20.0, 0.01), std::pair(20.0, 0.1)}) {
        const auto &hz = given.first, &depth = given.second;
        INFO(hz << " Hz, " << depth << " m");
        HapticRig rig = settledRig(hz, depth);
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

TEST_CASE("While forces return, what a slow low-pass still holds of a contact that ended only falls") {
    for (const double hz : {0.5, 2.0, 5.0}) {
        for (const int off : {20, 150}) { // ticks
            CAPTURE(hz);
            CAPTURE(off);
            HapticRig rig = settledRig(hz, 0.03);
            rig.forcesOff = true;
            rig.ticks(off);
            rig.forcesOff = false;
            rig.ticks(20);
            rig.hand = at(0, 0, 0.03);
            double before = forceOf(rig.step());
            REQUIRE(before > 0.05);
            for (int tick = 0; tick < 300; ++tick) {
                const double now = forceOf(rig.step());
                CHECK(now <= before);
                before = now;
            }
        }
    }
}

TEST_CASE("A low slew limit slows the rise of a force, and neither its fall nor the dead-man switch") {
    Scene scene = handScene();
    scene.haptics.slewForce = 20.0;
    scene.haptics.slewTorque = 0.2;
    scene.haptics.stiffness = 1000.0;
    for (const double period : {0.0, 0.004}) { // [s] measured; 0: nominal
        for (const double depth : {0.015, 0.05}) {
            for (const bool leaves : {true, false}) {
                INFO(period << " s, " << depth << " m, " << leaves);
                HapticRig rig = pressedRig(scene);
                CHECK(forceOf(rig.step()) < 2.5); // after 0.1 s
                rig.hand = at(0, 0, 0.01 - depth);
                rig.ticks(1100);
                CHECK(forceOf(rig.step()) > 14.0);
                rig.measured = period;
                rig.hand.position.z += leaves ? 0.15 : 0.0;
                rig.forcesOff = !leaves;
                for (int tick = 0; tick < 205; ++tick) {
                    const StepRecord record = rig.step();
                    CHECK((record.state != StepState::Off || forceOf(record) < 0.2));
                }
                CHECK(forceOf(rig.step()) == 0.0);
            }
        }
    }
}

TEST_CASE("The force of a wall that the hand left for another one ends within a ramp") {
    for (const auto& given : {std::pair(20.0, 0.0), std::pair(5.0, 0.0), std::pair(2000.0, 0.1)}) {
        const auto &slew = given.first, &hz = given.second;
        INFO(slew << " N/s, " << hz << " Hz");
        Scene scene; // of shapes alone: walls at x = -25 and 25 mm
        scene.haptics.device = "ideal";
        scene.haptics.stiffness = 500.0;
        scene.haptics.slewForce = slew;
        scene.haptics.lowpassHz = hz;
        std::array<Shape, 2> walls;
        for (Shape& wall : walls) {
            const double side = &wall == walls.data() ? -1.0 : 1.0;
            wall.kind = ShapeKind::Plane;
            wall.baseTshape = {{side * 0.025, 0, 0}, rotationExp({0, -side * kTurn / 4.0, 0})};
        }
        const Tool tool = ballTool();
        HapticCycle cycle(tool, walls, makeHapticOptions(springsAlone(scene), tool), at(0, 0, 0));
        StepInput input;
        double wrongWay = 0.0; // [N] 0.2 s after the hand left the first wall
        for (int tick = 0; tick < 4500; ++tick) {
            const double to = tick < 2500 ? std::max(-0.045, -0.00015 * tick)
                                          : std::min(0.045, -0.045 + 0.0009 * (tick - 2500));
            input.deviceThandle.position.x = to;
            const StepRecord record = cycle.step(input);
            wrongWay = std::max(wrongWay, tick > 2740 ? record.wrench.force.x : 0.0);
            input.time += 0.001;
        }
        CHECK(wrongWay <= 0.0);
    }
}
