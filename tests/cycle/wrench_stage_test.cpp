// SPDX-License-Identifier: Apache-2.0
// The last part of a step by itself: shifts of the hand map, and the cause of a torque.
#include "engine/cycle/wrench_stage.h"

#include "tests/cycle/haptic_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A stage whose forces are on, for a hand at the origin.
struct Stage {
    HapticOptions options = makeHapticOptions(springsAlone(handScene()), ballTool());
    WrenchInput input;
    std::optional<WrenchStage> stage;

    void start() {
        stage.emplace(options);
        input.springs = options.springs;
        input.forcesOn = true;
        input.pushes = cause::kRow;
        for (int i = 0; i < 3000; ++i) {
            stage->step(input);
        }
    }
};

} // namespace

TEST_CASE("A torque that its slew limit holds back has that cause, also without a force") {
    Stage hand;
    hand.options.passivityController = false;
    hand.options.slewTorque = 0.1; // [N m/s]
    hand.start();
    CHECK((hand.stage->step(hand.input).cause & cause::kSlew) == 0);
    hand.input.end.rotation = hand.input.device.rotation = rotationExp({0.05, 0, 0});
    const WrenchStage::Output turned = hand.stage->step(hand.input);
    CHECK(turned.wrench.force == dvec3(0.0));
    CHECK(glm::length(turned.wrench.torque) == doctest::Approx(1e-4));
    CHECK((turned.cause & cause::kSlew) != 0);
}

TEST_CASE("The springs' damping does not brake a shift of the hand map") {
    Stage hand;
    hand.options.springs.damping = 0.1;
    hand.start();
    for (int i = 0; i < 100; ++i) {
        hand.input.end.position.z = hand.input.device.position.z = -5e-5 * i;
        hand.stage->step(hand.input);
    }
    const Wrench before = hand.stage->step(hand.input).wrench;
    REQUIRE(before.force.z > 4.0);
    const dvec3 by(0, 0, -0.002);
    hand.stage->shift(by, {1, 0, 0, 0});
    for (Pose* pose : {&hand.input.end, &hand.input.device, &hand.input.allowed, &hand.input.tool}) {
        pose->position += by;
    }
    CHECK(glm::distance(hand.stage->step(hand.input).wrench.force, before.force) < 1e-9);
}
