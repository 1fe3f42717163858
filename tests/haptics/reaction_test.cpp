// SPDX-License-Identifier: Apache-2.0
// The reaction of the regions.
#include "engine/haptics/reaction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr double kPeriod = 0.001;

ReactionInput tickAt(double allowed, double hand) {
    ReactionInput tick;
    tick.springs.stiffness = 1000.0;
    tick.springs.rotationalStiffness = 1.0;
    tick.springs.metricRadius = std::sqrt(1e-3);
    tick.period = kPeriod;
    tick.allowed.position.z = allowed;
    tick.springEnd.position.z = hand;
    return tick;
}

double forceOf(const Wrench& wrench) {
    return glm::length(wrench.force);
}

// Pressed by the hand's own motion, 0.05 m/s, to `depth` [m] below the plane z = 0.
Reaction pressed(double depth) {
    Reaction reaction;
    for (double z = 0.0; z < depth; z += 5e-5) {
        reaction.step(tickAt(0.0, -z));
    }
    reaction.step(tickAt(0.0, -depth));
    return reaction;
}

} // namespace

TEST_CASE("Without an active row there is no reaction, however far the hand is") {
    Reaction reaction;
    for (const double hand : {0.0, 0.01, -0.3, 5.0}) {
        CHECK(forceOf(reaction.step(tickAt(hand, hand))) == 0.0);
    }
}

TEST_CASE("A reaction follows the hand that compresses it in the same tick, at any speed") {
    for (const double speed : {0.001, 0.1, 2.0}) {
        Reaction reaction;
        double z = 0.0;
        for (int i = 0; i < 20; ++i) {
            const Wrench wrench = reaction.step(tickAt(0.0, -z));
            CHECK(wrench.force.z == doctest::Approx(1000.0 * z));
            z += speed * kPeriod;
        }
    }
}

TEST_CASE("A reaction that appears without the hand rises by 100 N/s, and falls at once") {
    Reaction reaction;
    reaction.step(tickAt(-0.02, -0.02));
    double before = 0.0;
    for (int i = 0; i < 100; ++i) { // a row takes the tool back to 0: 20 N
        const double force = forceOf(reaction.step(tickAt(0.0, -0.02)));
        CHECK(force - before <= 0.1 + 1e-9);
        before = force;
    }
    CHECK(before == doctest::Approx(10.0));
    CHECK(forceOf(reaction.step(tickAt(-0.019, -0.02))) == doctest::Approx(1.0));
}

TEST_CASE(
    "New data lifts the hand evenly over the time between frames, by at most twice the surface's speed") {
    for (const double speed : {0.03, 0.1}) {
        Reaction reaction = pressed(0.005);
        double surface = 0.0, before = 5.0, steepest = 0.0;
        for (int i = 0; i < 200; ++i) {
            ReactionInput tick = tickAt(surface, -0.005);
            if (i % 33 == 0) {
                surface += 0.033 * speed;
                tick = tickAt(surface, -0.005);
                tick.newData = true;
            }
            const double force = forceOf(reaction.step(tick));
            steepest = std::max(steepest, (force - before) / kPeriod);
            before = force;
        }
        CHECK(steepest <= 2.0 * 1000.0 * speed);
        CHECK(steepest >= 0.8 * std::min(1000.0 * speed, Reaction::kMaxRiseRate));
    }
}

TEST_CASE("Rows that are stale let the reaction fall and never rise") {
    Reaction reaction = pressed(0.005);
    ReactionInput tick = tickAt(0.0, -0.02);
    tick.mayRise = false;
    CHECK(forceOf(reaction.step(tick)) == doctest::Approx(5.0));
    tick = tickAt(0.0, -0.003);
    tick.mayRise = false;
    CHECK(forceOf(reaction.step(tick)) == doctest::Approx(3.0));
    tick = tickAt(0.0, -0.02);
    tick.mayRise = false;
    CHECK(forceOf(reaction.step(tick)) == doctest::Approx(3.0));
}

TEST_CASE("What vanished under the hand fades out within 0.2 s and falls in every tick") {
    Reaction reaction = pressed(0.005);
    double before = 5.0;
    for (int i = 0; i < 200; ++i) {
        ReactionInput tick = tickAt(-0.005, -0.005);
        tick.vanished = i == 0;
        const double force = forceOf(reaction.step(tick));
        CHECK((force < before || (force == 0.0 && i == 199)));
        before = force;
    }
    CHECK(before <= 1e-9);
    CHECK_FALSE(reaction.fades());
}

TEST_CASE("A small new reaction replaces only its own size of the fading force, and for good") {
    Reaction reaction = pressed(0.005);
    double force = 5.0;
    const auto follow = [&](double allowed, int ticks) { // 5 N fall by 25 mN in each tick
        for (int i = 0; i < ticks; ++i) {
            ReactionInput tick = tickAt(allowed, -0.005);
            tick.vanished = allowed == -0.005 && i == 0;
            const double now = forceOf(reaction.step(tick));
            CHECK(now <= force + 1e-9);
            CHECK(now >= force - 0.026);
            force = now;
        }
    };
    follow(-0.005, 20);
    follow(-0.0046, 50); // a region that presses with 0.4 N
    follow(-0.005, 20);  // it vanishes, too
    follow(-0.0046, 50); // another one
    const double left = forceOf(reaction.step(tickAt(-0.005, -0.005)));
    CHECK(left == doctest::Approx(force - 0.4).epsilon(0.02));
}

TEST_CASE("New data that turns a reaction by much is felt as an even turn over a frame, and the rest over "
          "0.3 s") {
    Reaction reaction = pressed(0.005);
    ReactionInput tick = tickAt(0.0, -0.005);
    for (int frame = 0; frame < 3; ++frame) { // 20 ms between frames
        for (int k = 0; k < 20; ++k) {
            tick.newData = k == 0;
            reaction.step(tick);
        }
    }
    tick.allowed.position = {0.003, 0.0, -0.001}; // 5 mm from the hand, turned by 37 degrees
    double before = 0.0;
    for (int k = 0; k < 20; ++k) {
        tick.newData = k == 0;
        const Wrench wrench = reaction.step(tick);
        const double turn = std::atan2(wrench.force.x, wrench.force.z);
        CHECK(forceOf(wrench) <= 5.0);
        CHECK(forceOf(wrench) > 4.4);
        CHECK(turn - before > 0.0);
        CHECK(turn - before < 0.05);
        CHECK((reaction.appears() || k > 17)); // its work is not the hand's
        before = turn;
    }
    CHECK(before > 0.3 * std::atan2(3.0, 4.0));
    tick.newData = false;
    Wrench wrench;
    for (int k = 0; k < 9000; ++k) {
        wrench = reaction.step(tick);
    }
    CHECK(std::atan2(wrench.force.x, wrench.force.z) == doctest::Approx(std::atan2(3.0, 4.0)).epsilon(1e-3));
    CHECK_FALSE(reaction.appears());
    tick.allowed.position = tick.springEnd.position; // no row any more: no force after a frame
    for (int k = 0; k < 34; ++k) {
        tick.newData = k == 0;
        wrench = reaction.step(tick);
    }
    CHECK(forceOf(wrench) == 0.0);
}

TEST_CASE("Noise of a surface reaches the hand slowly, and the hand's own motion in the same tick") {
    Reaction reaction = pressed(0.01);
    constexpr std::array kShake{0.4, -0.7, 0.9, -0.2, -0.9, 0.6, 0.1, -0.5, 0.8, -0.5}; // [mm]
    double shaken = 0.0, felt = 0.0, mean = 0.0, hand = -0.01, force = 10.0;
    for (size_t i = 0; i < 3300; ++i) {
        const double surface = 1e-3 * kShake[i / 33 % kShake.size()];
        const bool moves = i % 330 == 20;
        hand -= moves ? 1e-4 : 0.0;
        ReactionInput tick = tickAt(surface, hand);
        tick.newData = i % 33 == 0;
        const double now = forceOf(reaction.step(tick));
        CHECK((!moves || now - force == doctest::Approx(0.1).epsilon(0.03)));
        force = now;
        shaken += std::pow(1000.0 * surface, 2) / 3300, felt += std::pow(now + 1000.0 * hand, 2) / 3300;
        mean += (now + 1000.0 * hand) / 3300;
    }
    CHECK(std::sqrt(felt) < 0.2 * std::sqrt(shaken));
    CHECK(std::abs(mean) < 0.05);
}

TEST_CASE("A change of a surface that stays is felt with a time constant of 0.3 s, whatever its size") {
    const auto feltAfter = [](double change, int ticks) { // [1] share of the change
        Reaction reaction = pressed(0.02);
        ReactionInput tick = tickAt(change, -0.02);
        double force = 0.0;
        for (int i = 0; i < ticks; ++i) {
            tick.newData = i == 0;
            force = forceOf(reaction.step(tick));
        }
        return (force / 1000.0 - 0.02) / change;
    };
    for (const double change : {0.0002, -0.0002, 0.002}) {
        CAPTURE(change);
        CHECK(feltAfter(change, 33) < 0.2);
        CHECK(feltAfter(change, 300) == doctest::Approx(0.63).epsilon(0.02));
        CHECK(feltAfter(change, 6000) > 0.98);
    }
}

TEST_CASE("New data that turns a reaction by up to 11 degrees is felt slowly, however deep the hand is") {
    for (const double depth : {0.02, 0.05}) {
        for (const int late : {0, 11}) { // [ticks] until the tool has followed the surface
            CAPTURE(depth);
            CAPTURE(late);
            Reaction reaction = pressed(depth);
            ReactionInput tick = tickAt(0.0, -depth);
            double turned = 0.0;
            for (int i = 0; i < 60; ++i) {
                tick.newData = i == 0;
                tick.allowed.position.x = i < late ? 0.0 : 0.19 * depth;
                const Wrench wrench = reaction.step(tick);
                turned = std::abs(std::atan2(wrench.force.x, wrench.force.z));
            }
            CHECK(turned > 0.0);
            CHECK(turned < 0.2 * std::atan(0.19));
        }
    }
}

TEST_CASE("A tool that lags keeps its reaction while it follows a surface that new data moved") {
    for (const bool lags : {true, false}) {
        Reaction reaction = pressed(0.02);
        ReactionInput tick = tickAt(-0.018, -0.02); // rows that hold back only 2 mm
        tick.lags = lags;
        double least = 20.0, before = 20.0, step = 0.0;
        for (int i = 0; i < 400; ++i) {
            tick.newData = i == 0;
            tick.allowed.position.z = i < 10 ? -0.018 : 0.0; // it has caught up
            const double force = forceOf(reaction.step(tick));
            least = std::min(least, force), step = std::max(step, std::abs(force - before));
            before = force;
        }
        CHECK((!lags || before == doctest::Approx(20.0)));
        CHECK(lags == (least > 18.8));
        CHECK(lags == (step < 0.11));
    }
    Reaction reaction = pressed(0.02); // what is really gone fades out
    ReactionInput tick = tickAt(-0.02, -0.02);
    tick.lags = true, tick.newData = true;
    double before = 20.0 + 1e-9;
    for (int i = 0; i < 200; ++i, tick.newData = false) {
        const double force = forceOf(reaction.step(tick));
        CHECK(force < before);
        before = force;
    }
    CHECK(forceOf(reaction.step(tick)) == 0.0);
}

TEST_CASE("A surface that approaches is felt at most 2 mm late, and one that is gone ends within a frame") {
    Reaction reaction = pressed(0.01);
    double surface = 0.0;
    ReactionInput tick;
    for (int i = 0; i < 660; ++i) { // 3 mm in each frame
        surface += i % 33 == 0 ? 0.003 : 0.0;
        tick = tickAt(surface, -0.01);
        tick.newData = i % 33 == 0;
        const double force = forceOf(reaction.step(tick));
        CHECK((i % 33 != 32 || force > 1000.0 * (surface + 0.01) - 2.0 - 1e-9));
    }
    tick.allowed = tick.springEnd;
    double before = 1000.0 * (surface + 0.01);
    for (int i = 0; i < 34; ++i) {
        tick.newData = i == 0;
        const double force = forceOf(reaction.step(tick));
        CHECK(before - force < 1000.0 * (surface + 0.01) / 33.0 + 2.0 * (i == 0));
        before = force;
    }
    CHECK(before == 0.0);
}
