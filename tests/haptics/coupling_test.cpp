// SPDX-License-Identifier: Apache-2.0
// Coupling and presets: the spring law, the bounds against a numerical supremum, the margins.
#include "engine/haptics/coupling.h"
#include "engine/haptics/limits.h"
#include "engine/types/error.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <string>

using namespace fathom;

namespace {

using Complex = std::complex<double>;

// (T/2) sup Re{(1 - e^-jw) H(e^jw)} / (1 - cos w) on a fine grid over (0, pi).
template <class Transfer>
double neededDamping(double period, Transfer transfer) {
    double largest = -1e300;
    for (int i = 1; i < 20000; ++i) {
        const double w = 3.14159265358979323846 * i / 20000.0;
        const Complex back = std::polar(1.0, -w);
        largest = std::max(largest, std::real((1.0 - back) * transfer(back)) / (1.0 - std::cos(w)));
    }
    return 0.5 * period * largest;
}

} // namespace

TEST_CASE("The passive bound equals the numerical supremum with damping and no delay, and with delay and no "
          "damping") {
    const double T = 0.001, K = 700.0;
    for (const double B : {0.0, 0.3, -0.3, 2.0}) {
        const double needed = neededDamping(T, [&](Complex back) { return K + B * (1.0 - back) / T; });
        CHECK(needed == doctest::Approx(K * T / 2.0 + std::abs(B)).epsilon(1e-6));
    }
    for (const int n : {1, 2, 5}) {
        const double needed = neededDamping(T, [&](Complex back) { return K * std::pow(back, n); });
        CHECK(needed == doctest::Approx(K * T * (1.0 + 2.0 * n) / 2.0).epsilon(1e-4));
        for (const double B : {0.5, 3.0}) { // both: an upper bound
            const double both = neededDamping(
                T, [&](Complex back) { return (K + B * (1.0 - back) / T) * std::pow(back, n); });
            CHECK(both <= K * T * (1.0 + 2.0 * n) / 2.0 + B);
        }
    }
}

TEST_CASE("The low-pass counts as the delay that it reports") {
    const double T = 0.001, K = 500.0;
    for (const double hz : {5.0, 30.0, 150.0}) {
        const double a = lowPassGain(hz, T), n = lowPassDelayTicks(a);
        const double needed =
            neededDamping(T, [&](Complex back) { return K * a / (1.0 - (1.0 - a) * back); });
        CHECK(needed == doctest::Approx(K * T * (1.0 + 2.0 * n) / 2.0).epsilon(1e-3));
    }
    CHECK(lowPassGain(0.0, T) == 1.0);
    CHECK(lowPassDelayTicks(1.0) == 0.0);
}

TEST_CASE("The stability rule gives 200, 1000 and 4000 N/m without delay and a third with one tick") {
    CHECK(passiveStiffness(0.1, 0.0, 0.001, 0.0) == doctest::Approx(200.0));
    CHECK(passiveStiffness(0.5, 0.0, 0.001, 0.0) == doctest::Approx(1000.0));
    CHECK(passiveStiffness(2.0, 0.0, 0.001, 0.0) == doctest::Approx(4000.0));
    CHECK(passiveStiffness(0.5, 0.0, 0.001, 1.0) == doctest::Approx(1000.0 / 3.0));
    CHECK(passiveStiffness(0.5, 0.0, 0.001, 2.0) == doctest::Approx(200.0));
    CHECK(passiveStiffness(0.5, -0.2, 0.001, 0.0) == doctest::Approx(600.0));
    CHECK(passiveStiffness(0.5, 0.7, 0.001, 0.0) < 0.0);
}

TEST_CASE("A sampled spring on a free device is stable below the uncoupled bound and grows above it") {
    const double T = 0.001, m = 0.15, b = 0.5;
    for (const double B : {0.0, 0.2}) {
        for (const double factor : {0.93, 1.07}) {
            const double K = factor * (b + B) / (T / 2.0);
            // Exact step of m v' = -b v + f over one period with constant force.
            const double decay = std::exp(-b * T / m);
            double x = 1e-3, v = 0.0, before = x, largest = 0.0;
            for (int i = 0; i < 200000; ++i) {
                const double f = -K * x - B * (x - before) / T;
                before = x;
                x += f / b * T + (v - f / b) * m / b * (1.0 - decay);
                v = f / b + (v - f / b) * decay;
                largest = i >= 195000 ? std::max(largest, std::abs(x)) : 0.0;
            }
            CHECK((largest < 1e-3) == (factor < 1.0));
        }
    }
}

TEST_CASE(
    "Auto uses the smaller of preset and bound, divided by the hand's scale, and k follows the springs") {
    CouplingOptions options;
    options.toolRadius = 0.02;
    auto springs = makeSprings(devicePreset("ideal"), options);
    CHECK(springs.stiffness == doctest::Approx(1000.0));
    CHECK(springs.rotationalStiffness == doctest::Approx(0.4));
    CHECK(springs.metricRadius == doctest::Approx(0.02));
    options.delayTicks = 1.0;
    CHECK(makeSprings(devicePreset("ideal"), options).stiffness == doctest::Approx(1000.0 / 3.0));
    options.period = 0.00025; // 4 kHz: the preset is now the smaller
    options.delayTicks = 0.0;
    CHECK(makeSprings(devicePreset("ideal"), options).stiffness == doctest::Approx(1000.0));
    options.period = 0.001;
    options.handScale = 2.0;
    springs = makeSprings(devicePreset("ideal"), options);
    CHECK(springs.stiffness == doctest::Approx(500.0));
    CHECK(*stabilityMargins(devicePreset("ideal"), springs, options).passive == doctest::Approx(0.0));
    // b unknown: the preset's stiffness, rendered at 1 kHz without delay, replaces it.
    options = {};
    CHECK(makeSprings(devicePreset("touch"), options).stiffness == 400.0);
    options.period = 0.00025;
    CHECK(makeSprings(devicePreset("touch"), options).stiffness == 400.0);
    options.period = 0.002;
    options.delayTicks = 3.0;
    CHECK(makeSprings(devicePreset("touch"), options).stiffness == doctest::Approx(400.0 / 14.0));
    CHECK_FALSE(stabilityMargins(devicePreset("touch"), makeSprings(devicePreset("touch"), options), options)
                    .passive);
}

TEST_CASE("When its bound lowers the rotational stiffness, k follows") {
    CouplingOptions options;
    options.toolRadius = 0.2; // k0^2 K_t = 40 N m/rad, above 2 b_r / T = 20
    const auto springs = makeSprings(devicePreset("ideal"), options);
    CHECK(springs.rotationalStiffness == doctest::Approx(20.0));
    CHECK(springs.metricRadius == doctest::Approx(std::sqrt(20.0 / 1000.0)));
    options.handScale = 0.5; // K_t = 2000; the hand feels K_r / s, so that K_r <= 20 s
    const auto fine = makeSprings(devicePreset("ideal"), options);
    CHECK(fine.stiffness == doctest::Approx(2000.0));
    CHECK(fine.rotationalStiffness == doctest::Approx(10.0));
    options = {};
    options.stiffness = 250.0;
    options.rotationalStiffness = 1.0;
    CHECK(makeSprings(devicePreset("ideal"), options).metricRadius ==
          doctest::Approx(std::sqrt(1.0 / 250.0)));
}

TEST_CASE("A rotational stiffness that no solver's metric can follow is moved to where k is in its range") {
    CouplingOptions options;
    options.stiffness = 1.0;
    options.rotationalStiffness = 1000.0; // k = 31.6 m
    const Springs high = makeSprings(devicePreset("ideal"), options);
    CHECK(high.metricRadius == 10.0);
    CHECK(high.rotationalStiffness == doctest::Approx(100.0));
    options.rotationalStiffness = 1e-10;
    const Springs low = makeSprings(devicePreset("ideal"), options);
    CHECK(low.metricRadius == 1e-4);
    CHECK(low.rotationalStiffness == doctest::Approx(1e-8));
    options.rotationalStiffness = 99.0;
    CHECK(makeSprings(devicePreset("ideal"), options).rotationalStiffness == 99.0);
}

TEST_CASE("With paper guidance both springs together stay within the bound, for automatic and given K_t") {
    CouplingOptions options;
    options.paperGuidance = true;
    const DevicePreset ideal = devicePreset("ideal");
    auto springs = makeSprings(ideal, options);
    CHECK(springs.guidanceStiffness == doctest::Approx(kGuidanceShare * springs.stiffness));
    CHECK(springs.stiffness + springs.guidanceStiffness == doctest::Approx(1000.0));
    CHECK(*stabilityMargins(ideal, springs, options).passive == doctest::Approx(0.0));
    options.stiffness = 900.0;
    springs = makeSprings(ideal, options);
    CHECK(springs.stiffness == 900.0);
    CHECK(springs.guidanceStiffness == doctest::Approx(100.0));
    options.stiffness = 1200.0;
    CHECK(makeSprings(ideal, options).guidanceStiffness == 0.0);
}

TEST_CASE("Both margins match the formulas, and a setup without spare damping is rejected") {
    CouplingOptions options;
    options.stiffness = 600.0;
    options.damping = 0.1;
    options.delayTicks = 1.0;
    const auto springs = makeSprings(devicePreset("ideal"), options);
    const auto margins = stabilityMargins(devicePreset("ideal"), springs, options);
    CHECK(*margins.passive == doctest::Approx(0.5 - (600.0 * 0.0015 + 0.1)));
    CHECK(*margins.uncoupled == doctest::Approx(0.5 - (600.0 * (0.0005 + 0.001) - 0.1)));
    options = {};
    options.damping = 0.6; // more than b: no stiffness is left
    CHECK_THROWS_AS(makeSprings(devicePreset("ideal"), options), Error);
    options = {};
    options.period = 0.0;
    CHECK_THROWS_AS(makeSprings(devicePreset("ideal"), options), Error);
    options = {};
    options.stiffness = std::nan("");
    CHECK_THROWS_AS(makeSprings(devicePreset("ideal"), options), Error);
}

TEST_CASE("The wrench is the negative gradient of the springs' energy over the device pose") {
    Springs springs;
    springs.stiffness = 800.0;
    springs.rotationalStiffness = 0.7;
    const Pose tool{{0.1, 0.2, 0.3}, rotationExp({0.3, -0.2, 0.5})};
    const Pose device{{0.11, 0.18, 0.33}, rotationExp({0.6, 0.1, -0.4})};
    const auto energy = [&](const Pose& at) {
        const dvec3 d = tool.position - at.position;
        const dvec3 turn = rotationBetween(at.rotation, tool.rotation);
        return 0.5 * springs.stiffness * glm::dot(d, d) +
               0.5 * springs.rotationalStiffness * glm::dot(turn, turn);
    };
    const Wrench wrench = couple(springs, tool, device);
    for (int i = 0; i < 3; ++i) {
        dvec3 step(0.0);
        step[i] = 1e-6;
        const double force = (energy({device.position - step, device.rotation}) -
                              energy({device.position + step, device.rotation})) /
                             2e-6;
        const double torque = (energy({device.position, rotationExp(-step) * device.rotation}) -
                               energy({device.position, rotationExp(step) * device.rotation})) /
                              2e-6;
        CHECK(wrench.force[i] == doctest::Approx(force).epsilon(1e-6));
        CHECK(wrench.torque[i] == doctest::Approx(torque).epsilon(1e-6));
    }
}

TEST_CASE(
    "Every preset is complete and states its source; an unknown name is rejected with the list of names") {
    for (const auto& preset : devicePresets()) {
        CAPTURE(preset.name);
        CHECK(&devicePreset(preset.name) == &preset);
        CHECK(preset.stiffness > 0.0);
        CHECK(preset.forceLimit > 0.0);
        CHECK(preset.torqueLimit > 0.0);
        CHECK(preset.source.size() > 20);
        for (int i = 0; i < 6; ++i) {
            CHECK((preset.sensed[i] || !preset.actuated[i])); // no motor without a sensor
        }
        if (!preset.damping && preset.name != "none") {
            CHECK(preset.source.find("unknown") != std::string::npos);
        }
    }
    const DevicePreset w5d = devicePreset("w5d");
    CHECK(w5d.sensed == AxisMask{true, true, true, true, true, true});
    CHECK(w5d.actuated == AxisMask{true, true, true, true, true, false});
    CHECK(w5d.source.find("assumption") != std::string::npos);
    CHECK(devicePreset("falcon").stiffness == 3000.0);
    CHECK(devicePreset("touch").forceLimit == 3.3);
    try {
        devicePreset("flacon");
        FAIL("accepted");
    } catch (const BadInput& error) {
        CHECK(std::string(error.what()).find("falcon") != std::string::npos);
        CHECK(std::string(error.what()).find("ideal") != std::string::npos);
        CHECK(error.exitCode() == 2);
    }
}
