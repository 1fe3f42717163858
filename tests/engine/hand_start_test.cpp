// SPDX-License-Identifier: Apache-2.0
// Where the hand starts, and where it continues after samples that no hand can make.
#include "tests/engine/wall_world.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A start more than 1000 km away is rejected") {
    for (const double far : {1.1e6, 1e300, 1e308}) {
        HandStart tool = startAt(0.5);
        tool.baseTtool = startAt(far).deviceThandle;
        CHECK_THROWS_AS(Lockstep(boxScene(), smallCamera(), startAt(far)), BadInput);
        CHECK_THROWS_AS(Lockstep(boxScene(), smallCamera(), tool), BadInput);
        Engine engine(boxScene(), smallCamera());
        CHECK_THROWS_AS(engine.openHand(startAt(far)), BadInput);
    }
    CHECK_NOTHROW(Lockstep(boxScene(), smallCamera(), startAt(-1e6)));
}

TEST_CASE("A start that is rejected is named with its field and value") {
    HandStart start = startAt(0.5);
    start.baseTtool = startAt(2e6).deviceThandle;
    CHECK_THROWS_WITH_AS(
        Lockstep(boxScene(), smallCamera(), start),
        "hand: start: baseTtool: position (0, 0, 2000000) m, rotation (1, 0, 0, 0) (allowed: a place within "
        "1000 km, a quaternion of non-zero length)",
        BadInput);
    start.deviceThandle.rotation = {0.0, 0.0, 0.0, 0.0};
    CHECK_THROWS_WITH_AS(
        Lockstep(boxScene(), smallCamera(), start),
        "hand: start: deviceThandle: position (0, 0, 0.5) m, rotation (0, 0, 0, 0) (allowed: a place within "
        "1000 km, a quaternion of non-zero length)",
        BadInput);
}

TEST_CASE("A hand that jumps after a broken sample, or before the first one, moves no tool") {
    const auto commandAfter = [](HandPort& hand, double z) {
        Step step;
        const Nanoseconds begun = now();
        while (now() < begun + 100'000'000) {
            step = hand.step(handAt(z), now());
        }
        CHECK(step.state == State::Free);
        CHECK(step.wrench.force == Vec3{0.0, 0.0, 0.0});
        return step.baseTcommand.position[2];
    };
    {
        Engine engine(boxScene(), smallCamera());
        HandPort hand = engine.openHand(startAt(0.5));
        hand.step(handAt(0.5), now());
        hand.step(handAt(std::nan("")), now());
        CHECK(commandAfter(hand, 0.9) == 0.5);
    }
    HandStart elsewhere;
    elsewhere.baseTtool = startAt(0.5).deviceThandle;
    Engine engine(boxScene(), smallCamera());
    HandPort hand = engine.openHand(elsewhere);
    CHECK(commandAfter(hand, 500.0) == 0.5);
}
