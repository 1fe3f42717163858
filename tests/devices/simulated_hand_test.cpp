// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/simulated_hand.h"

#include "engine/types/error.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>

using namespace fathom;

namespace {

const dquat kLevel(1.0, 0.0, 0.0, 0.0);

HandPath still(const Pose& pose = {}) {
    return HandPath({{0.0, pose, 0}});
}

SimulatedHandOptions strong() {
    SimulatedHandOptions options;
    options.loop = {0.2, 4.0, 300.0};
    return options;
}

// Runs the hand for a while at 1 kHz under one wrench; returns the time after.
double run(SimulatedHand& hand, const Wrench& wrench, double seconds, double from = 0.0) {
    const int ticks = static_cast<int>(std::lround(seconds * 1000.0));
    for (int i = 0; i < ticks; ++i) {
        hand.read(from + i * 0.001);
        hand.write(wrench, 0.001);
    }
    return from + ticks * 0.001;
}

} // namespace

TEST_CASE("A hand path is interpolated linearly and by the shortest arc, and is constant beyond its ends") {
    const dquat quarter = rotationExp({0.0, 0.0, std::acos(0.0)});
    const HandPath path({{1.0, {{0.0, 0.0, 0.0}, kLevel}, 4}, {3.0, {{0.2, 0.0, 0.4}, -quarter}, 1}});
    CHECK(path.duration() == 3.0);
    CHECK(path.at(-5.0).deviceThandle.position == dvec3(0.0));
    CHECK(path.at(0.0).buttons == 4);
    CHECK(path.at(1.0).buttons == 4);
    CHECK(path.at(2.999).buttons == 4);
    CHECK(path.at(3.0).buttons == 1);
    CHECK(path.at(99.0).deviceThandle.position == dvec3(0.2, 0.0, 0.4));
    const Pose middle = path.at(1.5).deviceThandle;
    CHECK(glm::length(middle.position - dvec3(0.05, 0.0, 0.1)) < 1e-15);
    CHECK(rotationLog(middle.rotation).z == doctest::Approx(std::acos(0.0) / 4.0).epsilon(1e-12));
}

TEST_CASE("A hand path of one waypoint is constant, and two waypoints at one time make a jump") {
    const HandPath one({{2.0, {{1.0, 2.0, 3.0}, kLevel}, 7}});
    for (const double t : {-1.0, 0.0, 2.0, 5.0}) {
        CHECK(one.at(t).deviceThandle.position == dvec3(1.0, 2.0, 3.0));
        CHECK(one.at(t).buttons == 7);
    }
    const HandPath jump(
        {{0.0, {}, 0}, {1.0, {{1.0, 0.0, 0.0}, kLevel}, 0}, {1.0, {{5.0, 0.0, 0.0}, kLevel}, 1}});
    CHECK(jump.at(0.999999).deviceThandle.position.x == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(jump.at(1.0).deviceThandle.position.x == 5.0);
}

TEST_CASE(
    "A hand path without waypoints, with numbers that are not finite or with time going back is refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(HandPath({}), Error);
    CHECK_THROWS_AS(HandPath({{nan, {}, 0}}), Error);
    CHECK_THROWS_AS(HandPath({{0.0, {{0.0, nan, 0.0}, kLevel}, 0}}), Error);
    CHECK_THROWS_AS(HandPath({{0.0, {{0.0, 0.0, 0.0}, dquat(0, 0, 0, 0)}, 0}}), Error);
    CHECK_THROWS_AS(HandPath({{1.0, {}, 0}, {0.5, {}, 0}}), Error);
}

TEST_CASE("A scripted hand follows its path under any force") {
    ScriptedHand hand(HandPath({{0.0, {}, 0}, {1.0, {{0.1, 0.0, 0.0}, kLevel}, 0}}));
    hand.write({{100.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, 0.001);
    CHECK(hand.read(0.5).deviceThandle.position.x == doctest::Approx(0.05).epsilon(1e-12));
}

TEST_CASE(
    "Under a constant force the simulated hand comes to rest at force over stiffness, likewise for torque") {
    SimulatedHand hand(still({{0.3, 0.0, 0.0}, kLevel}), strong());
    const Wrench wrench{{3.0, -1.5, 0.6}, {0.03, 0.0, -0.015}};
    run(hand, wrench, 3.0);
    CHECK(glm::length(hand.handle().position - dvec3(0.3, 0.0, 0.0) - wrench.force / 300.0) < 1e-9);
    CHECK(glm::length(rotationLog(hand.handle().rotation) - wrench.torque / (300.0 * 0.05 * 0.05)) < 1e-9);
    CHECK(glm::length(hand.velocity()) < 1e-9);
    CHECK(glm::length(hand.spin()) < 1e-9);
}

TEST_CASE(
    "Left alone the simulated hand loses energy from one swing to the next and swings at its own frequency") {
    SimulatedHandOptions options; // the scene's defaults: a light damper
    SimulatedHand hand(still(), options);
    run(hand, {{3.0, 0.0, 0.0}, {0.0, 0.02, 0.0}}, 5.0);
    const double swing = 2.0 * std::acos(-1.0) * std::sqrt(options.loop.mass / options.loop.stiffness);
    double before = hand.energy(0.0), t = 5.0;
    CHECK(before > 0.01);
    for (int i = 0; i < 8; ++i) {
        t = run(hand, {}, std::round(swing * 1000.0) / 1000.0, t);
        CHECK(hand.energy(t) < before);
        // exp(-D / m * swing) of the energy is left after a swing
        CHECK(hand.energy(t) ==
              doctest::Approx(before * std::exp(-options.loop.damping / options.loop.mass * swing))
                  .epsilon(0.03));
        before = hand.energy(t);
    }
    SimulatedHandOptions frictionless = options;
    frictionless.loop.damping = 0.0;
    SimulatedHand free(still(), frictionless);
    run(free, {{3.0, 0.0, 0.0}, {}}, 0.05);
    const double start = free.energy(0.0);
    run(free, {}, 20.0);
    CHECK(free.energy(0.0) ==
          doctest::Approx(start).epsilon(0.05)); // the integrator neither feeds nor brakes it
}

TEST_CASE("Under a constant force a free hand has moved by exactly F t^2 / (2 m) after any number of ticks") {
    SimulatedHandOptions options;
    options.loop = {0.1, 0.0, 0.0};
    SimulatedHand hand(still(), options);
    for (int i = 1; i <= 100; ++i) {
        run(hand, {{2.0, 0.0, 0.0}, {0.0, 0.0, 1e-4}}, 0.001);
        const double t = i * 0.001;
        CHECK(hand.handle().position.x == doctest::Approx(2.0 * t * t / 0.2).epsilon(1e-9));
        CHECK(hand.velocity().x == doctest::Approx(2.0 * t / 0.1).epsilon(1e-9));
        CHECK(rotationLog(hand.handle().rotation).z ==
              doctest::Approx(1e-4 * t * t / (2.0 * 0.1 * 0.0025)).epsilon(1e-9));
    }
}

TEST_CASE("The simulated hand follows a slow path closely and its buttons exactly") {
    const HandPath path({{0.0, {}, 0}, {2.0, {{0.2, 0.0, 0.0}, rotationExp({0.0, 0.0, 0.4})}, 1}});
    SimulatedHand hand(path, strong());
    run(hand, {}, 1.5);
    const HandSample sample = hand.read(1.5);
    // At 0.1 m/s against the damper 4 N s/m the spring is stretched by 0.4 N / 300 N/m.
    CHECK(sample.deviceThandle.position.x == doctest::Approx(0.15 - 0.4 / 300.0).epsilon(1e-3));
    CHECK(rotationLog(sample.deviceThandle.rotation).z ==
          doctest::Approx(0.3 - 0.2 * 4.0 / 300.0).epsilon(1e-3));
    CHECK(sample.buttons == 0);
    CHECK(hand.read(2.0).buttons == 1);
}

TEST_CASE("A write delay of n ticks shows the force n ticks later, to the tick") {
    for (const uint32_t delay : {0u, 1u, 5u, 64u}) {
        SimulatedHandOptions options = strong();
        options.delayTicks = delay;
        SimulatedHand hand(still(), options);
        uint32_t firstMoved = 0;
        for (uint32_t tick = 0; tick < 80 && firstMoved == 0; ++tick) {
            hand.read(tick * 0.001);
            hand.write({{1.0, 0.0, 0.0}, {}}, 0.001);
            firstMoved = hand.handle().position.x > 0.0 ? tick + 1 : 0;
        }
        CHECK(firstMoved == delay + 1);
    }
}

TEST_CASE("Encoders round what is read and never what moves") {
    SimulatedHandOptions options = strong();
    options.encoderStep = 1e-3, options.encoderAngle = 0.01;
    SimulatedHand coarse(still(), options), exact(still(), strong());
    for (int i = 0; i < 500; ++i) {
        const Pose read = coarse.read(i * 0.001).deviceThandle;
        exact.read(i * 0.001);
        CHECK(glm::length(read.position - exact.handle().position) <= 0.5e-3 * std::sqrt(3.0) + 1e-12);
        CHECK(std::abs(read.position.x / 1e-3 - std::nearbyint(read.position.x / 1e-3)) < 1e-9);
        CHECK(glm::length(rotationLog(read.rotation) - rotationLog(exact.handle().rotation)) < 0.5e-2 * 1.74);
        coarse.write({{2.0, 1.0, 0.0}, {0.01, 0.0, 0.0}}, 0.001);
        exact.write({{2.0, 1.0, 0.0}, {0.01, 0.0, 0.0}}, 0.001);
    }
    CHECK(coarse.handle().position == exact.handle().position);
}

TEST_CASE("An invalid wrench or period moves nothing, stiff and heavily damped hands stay finite, and "
          "invalid options are rejected") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    SimulatedHand hand(still(), strong());
    run(hand, {{nan, 0.0, 0.0}, {0.0, HUGE_VAL, 0.0}}, 0.1);
    hand.write({{1.0, 0.0, 0.0}, {}}, 0.0);
    hand.write({{1.0, 0.0, 0.0}, {}}, nan);
    CHECK(hand.handle().position == dvec3(0.0));
    SimulatedHandOptions stiff;
    stiff.loop = {0.01, 500.0, 50000.0};
    SimulatedHand extreme(still(), stiff);
    run(extreme, {{5.0, 0.0, 0.0}, {}}, 1.0);
    CHECK(extreme.handle().position.x == doctest::Approx(5.0 / 50000.0).epsilon(1e-6));
    const auto refused = [](auto change) {
        SimulatedHandOptions options;
        change(options);
        CHECK_THROWS_AS(SimulatedHand(still(), options), Error);
    };
    refused([](auto& o) { o.loop.mass = 0.0; });
    refused([](auto& o) { o.loop.stiffness = -1.0; });
    refused([nan](auto& o) { o.loop.damping = nan; });
    refused([](auto& o) { o.delayTicks = 65; });
}
