// SPDX-License-Identifier: Apache-2.0
// A shift of the hand map is no motion of the hand: it lets no force rise and generates no energy.
#include "engine/haptics/passivity.h"
#include "engine/haptics/reaction.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr dquat kUnturned(1.0, 0.0, 0.0, 0.0);

Springs shiftedSprings() {
    Springs springs;
    springs.stiffness = 1000.0;
    springs.rotationalStiffness = 0.4;
    springs.metricRadius = 0.02;
    return springs;
}

} // namespace

TEST_CASE("A reaction that appears while the hand map shifts rises as slowly as without the shift") {
    Reaction reaction;
    ReactionInput tick;
    tick.springs = shiftedSprings();
    for (int i = 0; i <= 100; ++i) { // pressed by the hand to 5 mm: 5 N
        tick.springEnd.position.z = -5e-5 * i;
        CHECK(glm::length(reaction.step(tick).force) == doctest::Approx(0.05 * i));
    }
    const dvec3 by(0, 0, -0.02);
    reaction.shift(by, kUnturned);
    tick.springEnd.position += by;
    tick.allowed.position = by + dvec3(0, 0, 0.01); // 10 mm more, without the hand
    CHECK(glm::length(reaction.step(tick).force) <= 5.0 + Reaction::kMaxRiseRate * tick.period + 1e-9);
}

TEST_CASE("A shift of the hand map against the force generates no energy, and one along it returns none") {
    for (const double way : {0.002, -0.002}) {
        PassivityController controller({0.5, 0.5 * 4e-4, 0.02, 0});
        PassivityStep tick;
        tick.springs = shiftedSprings();
        tick.contact.force = {0, 0, 3};
        tick.device.position = tick.springEnd.position = {0, 0, -0.003};
        for (int i = 0; i < 3; ++i) {
            controller.step(tick);
            controller.delivered(tick.contact, {});
        }
        const double before = controller.debt();
        const dvec3 by(0, 0, way);
        controller.shift(by, kUnturned);
        tick.device.position += by;
        tick.springEnd.position += by;
        controller.step(tick);
        CHECK(controller.generated() == doctest::Approx(0.0));
        CHECK(controller.debt() == before);
    }
}
