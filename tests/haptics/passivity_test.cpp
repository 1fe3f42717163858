// SPDX-License-Identifier: Apache-2.0
// The passivity observer counts only energy that a fixture generates, and the controller dissipates it by
// damping.
#include "engine/haptics/passivity.h"

#include "engine/haptics/limits.h"
#include "tests/haptics/allocation_count.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

using namespace fathom;

static_assert(noexcept(std::declval<PassivityController&>().step(std::declval<const PassivityStep&>())));
static_assert(noexcept(std::declval<PassivityController&>().delivered(std::declval<const Wrench&>(),
                                                                      std::declval<const Wrench&>())));

namespace {

constexpr double kPeriod = 0.001;

// A hand on a spring: K = 1000 N/m, K_r = 0.4 N m/rad (k = 20 mm), and a device with just enough damping for
// passivity.
struct Loop {
    double stiffness = 1000.0, radius = 0.02;
    PassivityOptions options;
    double forceLimit; // [N]
    PassivityController controller;
    Pose tool, hand;

    explicit Loop(double damping = 0.5, uint32_t delay = 0, double limit = 20.0)
        : options{damping, damping * radius * radius, radius, delay}
        , forceLimit(limit)
        , controller(options) {}

    Wrench spring() const {
        Springs s = springs();
        return couple(s, tool, hand);
    }
    Springs springs() const {
        Springs s;
        s.stiffness = stiffness;
        s.rotationalStiffness = stiffness * radius * radius;
        s.metricRadius = radius;
        return s;
    }
    // One tick: observe, then deliver spring (up to the force limit) and damper.
    Wrench step(double fadeGain = 1.0) {
        PassivityStep t;
        t.device = t.springEnd = hand;
        t.contact = spring();
        t.fadeGain = fadeGain;
        t.springs = springs();
        t.elapsed = kPeriod;
        t.forceLimit = forceLimit;
        const Wrench damper = controller.step(t);
        Wrench contact = t.contact;
        const double length = fadeGain * glm::length(contact.force);
        contact.force *= fadeGain * std::min(1.0, forceLimit / std::max(length, 1e-300));
        contact.torque *= fadeGain;
        controller.delivered(contact, damper);
        return damper;
    }
    // Two ticks: the hand stretches the spring by 3 mm, then the tool moves on by `jump` [m].
    void generate(double jump) {
        hand.position.z = -0.003;
        step();
        tool.position.z = jump;
        step();
    }
};

// Proxy on a flat wall at z = 0: the projection of the hand.
void rest(Loop& loop) {
    loop.tool.position = {loop.hand.position.x, loop.hand.position.y, std::max(0.0, loop.hand.position.z)};
}

} // namespace

TEST_CASE("On a static wall the controller stays inactive for any hand motion, up to the passive bound") {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (const double step : {1e-7, 1e-5, 1e-3, 2e-2}) {
        CAPTURE(step);
        Loop loop;
        for (int i = 0; i < 4000; ++i) {
            loop.hand.position += step * dvec3(normal(random), normal(random), normal(random));
            loop.hand.position.z = std::clamp(loop.hand.position.z, -0.05, 0.02);
            rest(loop);
            REQUIRE(isZero(loop.step()));
            REQUIRE(loop.controller.debt() <= 1e-12);
        }
        CHECK(loop.controller.generated() <= 1e-12);
        CHECK(loop.controller.dissipated() == 0.0);
    }
}

TEST_CASE("Rotations of any size against a fixed tool generate nothing either") {
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    Loop loop;
    for (int i = 0; i < 20000; ++i) {
        loop.hand.rotation = glm::normalize(
            rotationExp(0.05 * dvec3(normal(random), normal(random), normal(random))) * loop.hand.rotation);
        REQUIRE(isZero(loop.step()));
    }
    CHECK(loop.controller.debt() <= 1e-12);
}

TEST_CASE("A spring at its force limit stores less, and the difference does not count as generation") {
    Loop loop;
    for (int i = 0; i < 2000; ++i) { // to 60 mm, three times the limit, and back
        loop.hand.position.z = -0.06 * std::sin(3.14159265358979 * i / 2000.0);
        rest(loop);
        REQUIRE(isZero(loop.step()));
    }
    CHECK(loop.controller.generated() <= 1e-12);
}

TEST_CASE(
    "A wall that jumps by delta at penetration p is counted as K p delta + K delta^2 / 2 in the same tick") {
    for (const double jump : {0.0005, 0.002, 0.005}) {
        Loop loop;
        loop.generate(jump);
        CHECK(loop.controller.generated() ==
              doctest::Approx(1000.0 * (0.003 * jump + 0.5 * jump * jump)).epsilon(1e-9));
        CHECK(loop.controller.debt() ==
              doctest::Approx(loop.controller.generated()).epsilon(0.003)); // forgetting starts
        const double before = loop.controller.debt();
        loop.tool.position.z = 0.0; // back before the hand received any of it: no debt
        loop.step();
        CHECK(loop.controller.debt() <= 0.01 * before);
    }
}

TEST_CASE("The damper opposes the hand, is capped, and stops when the debt is dissipated") {
    Loop loop;
    loop.hand.position.z = -0.003;
    loop.step();
    loop.tool.position.z = 0.002; // 8 mJ
    double paid = 0.0;
    bool stopped = false;
    for (int i = 0; i < 400 && !stopped; ++i) {
        const dvec3 moved(1e-4, 0.0, 0.0); // 0.1 m/s along the wall: the spring does no work
        loop.hand.position += moved;
        loop.tool.position.x = loop.hand.position.x;
        const Wrench damper = loop.step();
        CHECK(damper.force.x <= 0.0);
        CHECK(damper.force.x >= -20.0 * 0.1 * (1.0 + 1e-9)); // 0.02 N s^2/m over 1 ms
        CHECK(damper.force.y == 0.0);
        CHECK(damper.torque == dvec3(0.0));
        paid += -damper.force.x * 1e-4;
        stopped = isZero(damper) && i > 5;
    }
    CHECK(stopped);
    CHECK(paid <= 0.008);
    CHECK(paid >= 0.004); // the device's own damping and the time constant took the rest
    CHECK(loop.controller.dissipated() == doctest::Approx(paid).epsilon(1e-9));
}

TEST_CASE(
    "Below 0.1 mm/s and 1 mrad/s nothing is damped; a rotation of the hand is damped only by a torque") {
    Loop loop;
    loop.generate(0.002);
    loop.hand.position.x += 0.9e-7;
    loop.tool.position.x += 0.9e-7;
    loop.hand.rotation = loop.tool.rotation = rotationExp({0.0, 0.9e-6, 0.0});
    CHECK(isZero(loop.step()));
    loop.hand.rotation = loop.tool.rotation = rotationExp({0.0, 1e-3, 0.0}) * loop.hand.rotation; // 1 rad/s
    const Wrench damper = loop.step();
    CHECK(damper.force == dvec3(0.0));
    CHECK(damper.torque.y < 0.0);
    CHECK(damper.torque.y >= -20.0 * 0.02 * 0.02 * (1.0 + 1e-9));
    CHECK(std::abs(damper.torque.x) + std::abs(damper.torque.z) <= 1e-12);
}

TEST_CASE("Beyond the bound every tick generates (K/2 - b/T) times its squared step") {
    Loop loop(0.25); // half the damping that 1000 N/m needs
    loop.hand.position.z = -0.001;
    rest(loop);
    loop.step();
    double expected = 0.0;
    for (int i = 0; i < 100; ++i) {
        const double step = (i % 2 == 0 ? -1.0 : 1.0) * 4e-5;
        loop.hand.position.z += step;
        rest(loop);
        loop.step();
        expected += (500.0 - 250.0) * step * step;
        CHECK(loop.controller.generated() == doctest::Approx(expected).epsilon(1e-6));
    }
    CHECK(expected > 0.0);
}

TEST_CASE("With a delay of n ticks the wrench is paired with the motion n ticks later") {
    Loop early(2.0, 0), late(2.0, 3);
    for (Loop* loop : {&early, &late}) {
        loop->hand.position.z = -0.004;
        loop->step();
    }
    // The first three wrenches have not reached the hand, so a hand that leaves in the meantime receives
    // nothing.
    for (Loop* loop : {&early, &late}) {
        loop->hand.position.z = 0.001;
        rest(*loop);
        loop->step();
    }
    // early: 4 N over 5 mm = 20 mJ out, 8 mJ were stored, 50 mJ damped; late: 0 out.
    CHECK(early.controller.generated() == 0.0);
    CHECK(late.controller.generated() == 0.0);
    for (Loop* loop : {&early, &late}) {
        for (int i = 0; i < 2; ++i) {
            loop->step();
        }
        loop->hand.position.z += 0.005; // in free space, while the delayed 4 N arrive
        rest(*loop);
        loop->step();
    }
    CHECK(early.controller.debt() <= 0.0);
    CHECK(late.controller.debt() > early.controller.debt());
}

TEST_CASE("Faded out, or given NaN, the controller resets and requests no damping") {
    for (const bool bad : {false, true}) {
        Loop loop;
        loop.generate(0.002);
        REQUIRE(loop.controller.debt() > 0.007);
        const Pose good = loop.hand;
        if (bad) {
            loop.hand.position.x = std::numeric_limits<double>::quiet_NaN();
            CHECK(isZero(loop.step()));
        } else {
            CHECK(isZero(loop.step(0.0)));
        }
        CHECK(loop.controller.debt() == 0.0);
        loop.hand = good;
        CHECK(isZero(loop.step()));
        loop.hand.position.x += 1e-4;
        CHECK(isZero(loop.step()));
    }
}

TEST_CASE("b is the preset's, divided by the hand map's scale; if unknown, the value that the preset's "
          "stiffness needs at 1 kHz") {
    CouplingOptions coupling;
    coupling.handScale = 2.0;
    const PassivityOptions known =
        makePassivity(devicePreset("ideal"), makeSprings(devicePreset("ideal"), coupling), coupling);
    CHECK(known.damping == doctest::Approx(0.25));
    CHECK(known.rotationalDamping == doctest::Approx(0.02));
    coupling.handScale = 1.0;
    const Springs springs = makeSprings(devicePreset("touch"), coupling);
    const PassivityOptions unknown = makePassivity(devicePreset("touch"), springs, coupling);
    CHECK(unknown.damping == doctest::Approx(0.2)); // 400 N/m
    CHECK(unknown.rotationalDamping == doctest::Approx(springs.rotationalStiffness * 0.0005));
}

TEST_CASE("The controller does not allocate") {
    Loop loop;
    const uint64_t before = allocationCount();
    for (int i = 0; i < 500; ++i) {
        loop.hand.position.z = -0.002 * (i % 7);
        loop.tool.position.z = 0.001 * (i % 3);
        loop.step(i % 100 == 99 ? 0.0 : 1.0);
    }
    CHECK(allocationCount() == before);
}
