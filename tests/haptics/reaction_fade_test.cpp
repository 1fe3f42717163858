// SPDX-License-Identifier: Apache-2.0
// What is left of a reaction whose regions are gone, and what new data turns round.
#include "engine/haptics/reaction.h"
#include "engine/haptics/wrench_metric.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace fathom;

namespace {

constexpr double kTick = 0.001;

ReactionInput springAt(double allowed, double hand) {
    ReactionInput tick;
    tick.springs.stiffness = 1000.0;
    tick.springs.rotationalStiffness = 1.0;
    tick.springs.metricRadius = std::sqrt(1e-3);
    tick.period = kTick;
    tick.allowed.position.z = allowed;
    tick.springEnd.position.z = hand;
    return tick;
}

// Pressed upwards by `newton`, by the hand's own motion.
Reaction pressedUp(double newton) {
    Reaction reaction;
    for (double z = 0.0; z < 0.001 * newton; z += 5e-5) {
        reaction.step(springAt(0.0, -z));
    }
    reaction.step(springAt(0.0, -0.001 * newton));
    return reaction;
}

} // namespace

TEST_CASE("A fading force yields to a region that faces it") {
    ReactionFade fade;
    fade.begin({{3.0, 0.0, 20.0}, {}}, 0.0, 0.03);
    Wrench rest;
    for (int i = 0; i < 80; ++i) {
        rest = fade.step({{0.0, 0.0, -2.0}, {}}, 0.0, 0.03, kTick);
    }
    CHECK(rest.force.z < 0.5);                                 // 12 N without the region
    CHECK(rest.force.x == doctest::Approx(1.8).epsilon(0.02)); // what does not face it fades by its own time
}

TEST_CASE("A fading force falls as the spring would when the hand moves out") {
    for (const double speed : {0.0, 0.05, 0.5}) {
        Reaction reaction = pressedUp(10.0);
        double hand = -0.01, force = 10.0;
        int ticks = 0;
        for (; ticks < 1000 && force > 0.0; ++ticks) {
            hand += speed * kTick;
            ReactionInput tick = springAt(hand, hand);
            tick.vanished = ticks == 0;
            const double now = glm::length(reaction.step(tick).force);
            CHECK(now < force);
            force = now;
        }
        const double springs = speed > 0.0 ? 10.0 / (1000.0 * speed * kTick) : 1e9; // [ticks]
        CHECK(ticks <= static_cast<int>(std::min(200.0, springs)) + 2);
    }
}

TEST_CASE("Force and torque of vanished regions fade from what was delivered, each from its own limit") {
    for (const double forceLimit : {20.0, 3.0}) {
        for (const double torqueLimit : {2.0, 0.1}) {
            Reaction reaction;
            ReactionInput tick = springAt(0.0, -0.01);
            tick.springEnd.rotation = rotationExp({0.3, 0.0, 0.0});
            tick.forceLimit = forceLimit, tick.torqueLimit = torqueLimit;
            for (int i = 0; i < 1000; ++i) {
                reaction.step(tick);
            }
            tick.allowed = tick.springEnd;
            tick.vanished = true;
            const Wrench first = reaction.step(tick);
            CHECK(glm::length(first.force) == doctest::Approx(std::min(10.0, forceLimit)).epsilon(0.01));
            CHECK(glm::length(first.torque) == doctest::Approx(std::min(0.3, torqueLimit)).epsilon(0.01));
        }
    }
}

TEST_CASE("A region that appears on the other side pushes away from itself from its first tick on") {
    for (const double old : {0.002, 0.1, 2.0, 10.0}) {
        for (const double speed : {0.0, 0.2}) { // [m/s] of the hand into it
            CAPTURE(old);
            CAPTURE(speed);
            Reaction reaction = pressedUp(old);
            double hand = -0.001 * old, most = -1e9, step = 0.0, before = 0.0;
            for (int i = 0; i < 66; ++i) {
                hand += speed * kTick;
                ReactionInput tick = springAt(-0.001 * old - 0.003, hand);
                tick.newData = i % 33 == 0;
                const double force = reaction.step(tick).force.z;
                most = std::max(most, force);
                step = i > 0 ? std::max(step, std::abs(force - before)) : 0.0;
                before = force;
            }
            CHECK(most <= 0.0);
            CHECK(step <= 0.1 + 1000.0 * speed * kTick + 1e-9);
        }
    }
}

TEST_CASE("A small force that was there before does not turn a large one that appears as well") {
    Reaction reaction = pressedUp(0.01);
    ReactionInput tick = springAt(0.0, -0.00001);
    tick.springEnd.position.x = -0.02; // to the side: 20 N
    double worst = 0.0;
    for (int i = 0; i < 33; ++i) {
        tick.newData = i == 0;
        const Wrench wrench = reaction.step(tick);
        worst = std::max(worst, wrench.force.z);
    }
    CHECK(worst <= 0.0201);
}

TEST_CASE("A hand that slides deep round a ball at rest feels no drag from frames that change nothing") {
    constexpr double kRound = 0.05, kDeep = 0.035; // [m] radius of ball and tool, depth
    double worst = 0.0;
    Reaction reaction;
    for (int i = 0; i < 2000; ++i) {
        const double angle = i < 500 ? 0.0 : 0.1 * kTick * (i - 500) / (kRound - kDeep);
        const double depth = std::min(kDeep, 1e-4 * i);
        const dvec3 out(std::sin(angle), 0.0, std::cos(angle));
        ReactionInput tick = springAt(0.0, 0.0);
        tick.allowed.position = kRound * out;
        tick.springEnd.position = (kRound - depth) * out;
        tick.newData = i % 33 == 0;
        const dvec3 force = reaction.step(tick).force;
        worst = i > 600 ? std::max(worst, glm::length(glm::cross(force, out)) / glm::length(force)) : 0.0;
    }
    CHECK(worst <= 0.03);
}
