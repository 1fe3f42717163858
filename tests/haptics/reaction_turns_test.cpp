// SPDX-License-Identifier: Apache-2.0
// A reaction that new data turns round.
#include "engine/haptics/reaction.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("New data on the other side of the hand begins a new reaction, from zero") {
    Reaction reaction;
    ReactionInput tick;
    tick.springs.stiffness = 1000.0;
    tick.springs.rotationalStiffness = 1.0;
    tick.springs.metricRadius = 0.03;
    for (int i = 0; i <= 100; ++i) { // pressed by the hand to 5 mm: 5 N up
        tick.springEnd.position.z = -5e-5 * i;
        reaction.step(tick);
    }
    tick.allowed.position.z = -0.025; // 20 mm below the hand: 20 N down
    tick.newData = true;
    Wrench wrench = reaction.step(tick);
    CHECK(glm::length(wrench.force) < 0.2);
    tick.newData = false;
    for (int i = 0; i < 20; ++i) {
        const Wrench next = reaction.step(tick);
        CHECK(glm::distance(next.force, wrench.force) <= 2.0 * Reaction::kMaxRiseRate * tick.period);
        wrench = next;
    }
    CHECK(wrench.force.z < 0.0);
}
