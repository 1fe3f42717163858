// SPDX-License-Identifier: Apache-2.0
// A reaction that new data turns round, or takes away.
#include "engine/haptics/reaction.h"

#include <algorithm>
#include <cmath>
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

TEST_CASE("A surface that goes back in every frame is felt as an even fall, not as a click per frame") {
    ReactionInput tick;
    tick.springs.stiffness = 1000.0;
    tick.springs.rotationalStiffness = 1.0;
    tick.springs.metricRadius = std::sqrt(1e-3);
    Reaction reaction;
    double force = 0.0, z = 0.0;
    const auto step = [&] {
        tick.springEnd.position.z = z;
        force = reaction.step(tick).force.z;
        tick.newData = false;
        return force;
    };
    for (; z > -0.02; z -= 5e-5) {
        step();
    }
    for (int i = 0; i < 1000; ++i) {
        step();
    }
    REQUIRE(force == doctest::Approx(20.0));
    for (int frame = 0; frame < 11; ++frame) {
        tick.newData = true;
        tick.allowed.position.z -= 0.005; // [m]
        for (int i = 0; i < 33; ++i) {
            const double before = force;
            z -= 0.0035 / 33.0;
            CHECK(before - step() < 0.35); // [N]; the surface goes back by 5 N per frame, the hand by 3.5 N
        }
    }
    CHECK(force < 4.0);
    tick.newData = true;
    for (int i = 0; i < 34; ++i) {
        tick.allowed = tick.springEnd; // no contact any more
        const double before = force;
        CHECK(before - step() < 0.2);
    }
    CHECK(force == 0.0);
}

namespace {

// A hand that presses a wall across z and a side across y, at 1000 N/m.
struct CornerHand {
    CornerHand() {
        tick.springs.stiffness = 1000.0;
        tick.springs.rotationalStiffness = 1.0;
        tick.springs.metricRadius = std::sqrt(1e-3);
    }
    dvec3 step() {
        tick.springEnd.position = hand;
        tick.allowed.position = {0.0, std::max(side, hand.y), std::max(wall, hand.z)};
        const Wrench felt = reaction.step(tick);
        tick.newData = false;
        return felt.force;
    }
    void pressTo(const dvec3& depth) {
        for (int i = 0; i < 200; ++i) {
            hand -= depth / 200.0;
            step();
        }
        for (int i = 0; i < 1000; ++i) {
            step();
        }
    }
    Reaction reaction;
    ReactionInput tick;
    dvec3 hand{0.0};
    double side = 0.0, wall = 0.0; // [m]
};

} // namespace

TEST_CASE("What a surface that goes back still gives ends with the spring of a hand that leaves") {
    CornerHand hand;
    hand.pressTo({0.0, 0.0, 0.01});
    hand.tick.newData = true;
    hand.wall = -0.006; // 4 N are left of 10
    CHECK(hand.step().z > 9.0);
    while (hand.hand.z < hand.wall + 0.002) {
        hand.hand.z += 0.0003; // 0.3 m/s
        const double felt = hand.step().z, spring = 1000.0 * std::max(0.0, hand.wall - hand.hand.z);
        CHECK(felt <= 2.5 * spring + 0.8);
    }
}

TEST_CASE("A surface that goes back to the hand or beyond ends its force within a frame, not as a blow") {
    for (const double beyond : {0.0, 0.001, 0.004}) {
        CAPTURE(beyond);
        CornerHand hand;
        hand.pressTo({0.0, 0.0, 0.01});
        hand.tick.newData = true;
        hand.wall = -0.01 - beyond;
        double before = 10.0;
        for (int i = 0; i < 34; ++i) {
            const double felt = hand.step().z;
            CHECK(before - felt < 0.33); // [N] 10 N evenly over 33 ms
            CHECK(felt <= before);
            CHECK(hand.reaction.size() == doctest::Approx(felt));
            before = felt;
        }
        CHECK(before == 0.0);
    }
}

TEST_CASE("What the device did not render is not held back") {
    CornerHand hand;
    hand.pressTo({0.0, 0.0, 0.01});
    hand.tick.newData = true;
    hand.tick.rendered = 2.0; // [N] of 10, for example while forces return
    hand.wall = -0.02;
    const double felt = hand.step().z;
    CHECK(felt < 2.0);
    CHECK(felt > 1.9);
}

TEST_CASE("The end of a surface's force is over when the hand has moved out as far as it was pressed") {
    CornerHand hand;
    hand.pressTo({0.0, 0.0, 0.004});
    hand.tick.newData = true;
    hand.wall = -0.004;
    CHECK(hand.step().z > 3.8);
    for (int i = 0; i < 10; ++i) {
        hand.hand.z += 0.0004;
        CHECK(hand.step().z <= 4.0 - 0.4 * (i + 1) + 1e-9);
    }
}

TEST_CASE("A reaction too small to be felt stays finite where it may not rise") {
    for (const double depth : {1e-16, 5e-10, 5e-7, 9e-7, 2e-6}) {
        CAPTURE(depth);
        CornerHand hand;
        hand.tick.mayRise = false;
        hand.step();
        hand.tick.newData = true;
        hand.hand.z = -depth;
        const dvec3 felt = hand.step();
        CHECK(felt == dvec3(0.0));
        hand.tick.mayRise = true;
        CHECK(hand.step().z <= 1000.0 * depth);
        CHECK(hand.step().z >= 0.0);
    }
}

TEST_CASE("A reaction that begins elsewhere takes over nothing of one that ended") {
    CornerHand hand;
    hand.pressTo({0.0, 0.0, 0.01});
    hand.tick.newData = true;
    hand.wall = -0.02;
    CHECK(hand.step().z > 9.0);
    hand.hand.y -= 0.0002; // 0.2 N
    const dvec3 felt = hand.step();
    CHECK(felt.y <= 0.21);
}

TEST_CASE("A region that appears while another one's force ends begins at zero, and the rest still ends") {
    for (const int ticks : {1, 8, 15}) {
        CAPTURE(ticks);
        CornerHand hand;
        hand.pressTo({0.0, 0.0, 0.005});
        hand.tick.newData = true;
        hand.wall = -0.02;
        dvec3 before{0.0};
        for (int i = 0; i < ticks; ++i) {
            before = hand.step();
        }
        hand.side = 0.003; // not by the hand: 3 N
        for (int i = ticks; i < 34; ++i) {
            const dvec3 felt = hand.step();
            CHECK(felt.y - before.y < 0.11);
            CHECK(before.z - felt.z < 0.35);
            CHECK(felt.z <= before.z);
            before = felt;
        }
        CHECK(before.z == 0.0);
        CHECK(before.y > 0.0);
    }
}

TEST_CASE("A surface that goes back nearly to a hand that moves out ends its force gradually, too") {
    for (const double rest : {5e-6, 2e-5, 5e-5}) {
        for (const double speed : {2e-6, 1e-5, 3e-5}) { // [m] per tick
            CAPTURE(rest);
            CAPTURE(speed);
            CornerHand hand;
            hand.pressTo({0.0, 0.0, 0.005});
            hand.tick.newData = true;
            hand.wall = -0.005 + rest;
            double before = 5.0;
            for (int i = 0; i < 34; ++i) {
                hand.hand.z += speed;
                const double felt = hand.step().z;
                CHECK(before - felt < 0.7); // at once it would be 5 N
                before = felt;
            }
            CHECK(before < 0.06);
        }
    }
}

TEST_CASE("What one region loses is not felt on another one") {
    for (const int ticks : {0, 3}) { // after the frame, until the tool follows
        CAPTURE(ticks);
        CornerHand hand;
        hand.pressTo({0.0, 0.0003, 0.005});
        REQUIRE(hand.step().z == doctest::Approx(5.0).epsilon(0.01));
        hand.tick.newData = true;
        for (int i = 0; i < ticks; ++i) {
            hand.step();
        }
        hand.wall = -0.0052;
        for (int i = 0; i < 60; ++i) {
            CHECK(hand.step().y < 0.35);
        }
    }
}
