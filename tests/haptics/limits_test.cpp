// SPDX-License-Identifier: Apache-2.0
// The limit functions, for random wrenches and edge cases.
#include "engine/haptics/limits.h"
#include "engine/reference/rng.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace fathom;

TEST_CASE("Force and torque are shortened as whole vectors and keep their direction") {
    Rng random(1);
    for (int i = 0; i < 5000; ++i) {
        const Wrench wrench{random.uniform(0.0, 50.0) * random.direction(),
                            random.uniform(0.0, 5.0) * random.direction()};
        const Wrench out = limitSize(wrench, 20.0, 2.0);
        CHECK(glm::length(out.force) <= 20.0 * (1.0 + 1e-15));
        CHECK(glm::length(out.torque) <= 2.0 * (1.0 + 1e-15));
        CHECK(glm::length(glm::cross(out.force, wrench.force)) <= 1e-12 * 2500.0);
        CHECK(glm::dot(out.force, wrench.force) >= 0.0);
        if (glm::length(wrench.force) <= 20.0) {
            CHECK(out.force == wrench.force); // excess torque does not affect the force
        }
        if (glm::length(wrench.torque) <= 2.0) {
            CHECK(out.torque == wrench.torque);
        }
    }
    CHECK(limitSize({dvec3(0.0), dvec3(0.0)}, 0.0, 0.0).force == dvec3(0.0));
    CHECK(glm::length(limitSize({dvec3(1, 2, 3), dvec3(1.0)}, 0.0, 0.0).force) == 0.0);
}

TEST_CASE("A projection keeps what lies along an axis of any length, and nothing of a zero axis") {
    CHECK(projectedOn({3, 4, 5}, {0, -0.25, 0}) == dvec3(0, 4, 0));
    CHECK(projectedOn({3, 4, 5}, dvec3(0.0)) == dvec3(0.0));
}

TEST_CASE("A slewed force moves by at most a step, arrives exactly, and stays inside the size limit") {
    Rng random(2);
    dvec3 now(0.0);
    for (int i = 0; i < 5000; ++i) {
        const dvec3 wanted = clampLength(40.0 * random.direction(), 20.0);
        for (int tick = 0; tick < 25; ++tick) {
            const dvec3 next = limitSlew(wanted, now, 2.0, 1.0);
            CHECK(glm::distance(next, now) <= 2.0 * (1.0 + 1e-12));
            CHECK(glm::length(next) <= 20.0 * (1.0 + 1e-12));
            now = next;
        }
        CHECK(glm::distance(now, wanted) <= 1e-12); // 40 N at most, 2 N per tick, 25 ticks
    }
}

TEST_CASE("With a low slew limit what is not wanted of a force falls by the fall, and the rest rises by the "
          "rise") {
    Rng random(3);
    for (int i = 0; i < 2000; ++i) {
        const dvec3 wanted = clampLength(40.0 * random.uniform(0.0, 1.0) * random.direction(), 20.0);
        dvec3 now = 20.0 * random.direction();
        for (int tick = 0; tick < 200; ++tick) {
            const dvec3 next = limitSlew(wanted, now, 0.02, 0.1);
            const dvec3 rest = now - wantedPart(now, wanted), left = next - wantedPart(next, wanted);
            CHECK(glm::length(left) <= std::max(0.0, glm::length(rest) - 0.1) + 1e-12);
            CHECK(glm::length(next) <= std::max(glm::length(now), glm::length(wanted)) * (1.0 + 1e-12));
            CHECK(glm::length(next) <= glm::length(now) + 0.02 * (1.0 + 1e-9));
            now = next;
        }
        CHECK(glm::distance(now, wantedPart(now, wanted)) <= 1e-12);
    }
}

TEST_CASE("The low-pass reaches 63.2 percent after 1 / (2 pi f), and passes exact values when off") {
    const double period = 0.001, hz = 10.0;
    const double gain = lowPassGain(hz, period);
    Wrench out;
    const Wrench in{{3.0, 0, 0}, {0, 0, 0.5}};
    const int ticks = 16; // 1 / (2 pi 10 Hz) = 15.9 ms
    for (int i = 0; i < ticks; ++i) {
        out = lowPass(in, out, gain);
    }
    CHECK(out.force.x ==
          doctest::Approx(3.0 * (1.0 - std::exp(-2.0 * 3.14159265358979 * hz * ticks * period))));
    CHECK(out.torque.z == doctest::Approx(0.5 / 3.0 * out.force.x));
    const Wrench odd{{0.1, 0.2, 0.3}, {1e-17, 0, 5}};
    CHECK(lowPass(odd, in, lowPassGain(0.0, period)).force == odd.force);
    // A ramp through the filter lags by the delay it reports.
    Wrench ramp;
    double lag = 0.0;
    for (int i = 0; i < 2000; ++i) {
        ramp = lowPass({dvec3(static_cast<double>(i), 0, 0), dvec3(0.0)}, ramp, gain);
        lag = i - ramp.force.x;
    }
    CHECK(lag == doctest::Approx(lowPassDelayTicks(gain)).epsilon(1e-9));
}

TEST_CASE("Projection keeps the wrench that the handle's motors can render, and the residual is the rest") {
    Rng random(3);
    const AxisMask noRoll{true, true, true, true, true, false},
        forceOnly{true, true, true, false, false, false};
    for (int i = 0; i < 2000; ++i) {
        const dquat q = rotationExp(random.uniform(0.0, 3.1) * random.direction());
        const Wrench wrench{random.direction(), random.direction()};
        const auto out = projectOnAxes(wrench, q, noRoll);
        const dvec3 roll = q * dvec3(0, 0, 1);
        CHECK(std::abs(glm::dot(out.delivered.torque, roll)) <= 1e-14);
        CHECK(glm::length(glm::cross(out.residual.torque, roll)) <= 1e-14);
        CHECK(glm::distance(out.delivered.force, wrench.force) <= 1e-14);
        CHECK(glm::distance(out.delivered.torque + out.residual.torque, wrench.torque) <= 1e-14);
        const auto none = projectOnAxes(wrench, q, forceOnly);
        CHECK(glm::length(none.delivered.torque) == 0.0);
        CHECK(none.residual.torque == wrench.torque);
        const auto all = projectOnAxes(wrench, q, {true, true, true, true, true, true});
        CHECK(all.delivered.force == wrench.force);
        CHECK(all.residual.torque == dvec3(0.0));
    }
}

TEST_CASE("The finite check covers each of the six numbers") {
    CHECK(isFinite(Wrench{}));
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (int i = 0; i < 3; ++i) {
            Wrench wrench;
            wrench.force[i] = bad;
            CHECK_FALSE(isFinite(wrench));
            wrench = {};
            wrench.torque[i] = bad;
            CHECK_FALSE(isFinite(wrench));
        }
    }
}
