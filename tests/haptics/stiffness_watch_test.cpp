// SPDX-License-Identifier: Apache-2.0
// The automatic stiffness follows the bound of slower ticks smoothly, and nothing else changes it.
#include "engine/haptics/stiffness_watch.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace fathom;

namespace {

StiffnessWatch watchOf(const CouplingOptions& options, const char* device = "ideal") {
    const DevicePreset preset = devicePreset(device);
    return {preset, options, makeSprings(preset, options)};
}

void run(StiffnessWatch& watch, double period, double seconds) {
    for (double t = 0.0; t < seconds; t += period) {
        watch.step(period);
    }
}

} // namespace

TEST_CASE("At the planned rate, or without a measurement, the springs do not change by a bit") {
    CouplingOptions options;
    options.toolRadius = 0.05;
    StiffnessWatch watch = watchOf(options);
    const Springs planned = watch.springs();
    for (const double period : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(), 0.001, 0.0005}) {
        for (int i = 0; i < 500; ++i) {
            watch.step(period);
        }
        CHECK(watch.springs().stiffness == planned.stiffness);
        CHECK(watch.springs().rotationalStiffness == planned.rotationalStiffness);
        CHECK(watch.springs().metricRadius == planned.metricRadius);
    }
}

TEST_CASE("Ticks of 2 ms halve the stiffness in a ramp, and it recovers afterwards") {
    CouplingOptions options;
    options.toolRadius = 0.05;
    StiffnessWatch watch = watchOf(options);
    double before = watch.springs().stiffness;
    CHECK(before == 1000.0);
    for (int i = 0; i < 500; ++i) {
        watch.step(0.002);
        CHECK(watch.springs().stiffness <= before);
        CHECK(before - watch.springs().stiffness <= 1000.0 * 0.002 / StiffnessWatch::kDown + 1e-9);
        before = watch.springs().stiffness;
    }
    CHECK(before == doctest::Approx(500.0));
    CHECK(watch.springs().rotationalStiffness == doctest::Approx(500.0 * 0.05 * 0.05));
    CHECK(watch.springs().metricRadius == doctest::Approx(0.05));
    run(watch, 0.001, 0.1);
    CHECK(watch.springs().stiffness < 600.0);
    run(watch, 0.001, 3.0);
    CHECK(watch.springs().stiffness == doctest::Approx(1000.0).epsilon(1e-9));
}

TEST_CASE("K_r has its own bound, and k follows both springs") {
    CouplingOptions options;
    options.toolRadius = 0.2; // k0^2 K_t = 40: cut to 20 by b_r
    StiffnessWatch watch = watchOf(options);
    CHECK(watch.springs().rotationalStiffness == doctest::Approx(20.0));
    run(watch, 0.002, 2.0);
    CHECK(watch.springs().rotationalStiffness == doctest::Approx(10.0));
    CHECK(watch.springs().stiffness == doctest::Approx(500.0));
    CHECK(watch.springs().metricRadius == doctest::Approx(std::sqrt(10.0 / 500.0)));
}

TEST_CASE("A given K_r follows a falling K_t where k would leave the range of the solvers") {
    CouplingOptions options;
    options.rotationalStiffness = 80'000.0; // k = 8.9 m at 1000 N/m
    StiffnessWatch watch = watchOf(options);
    CHECK(watch.springs().rotationalStiffness == 80'000.0);
    run(watch, 0.002, 2.0);
    CHECK(watch.springs().stiffness == doctest::Approx(500.0));
    CHECK(watch.springs().rotationalStiffness == doctest::Approx(50'000.0));
    CHECK(watch.springs().metricRadius == 10.0);
}

TEST_CASE("With a margin both springs keep that share of their bound at every rate") {
    CouplingOptions options;
    options.toolRadius = 0.2;
    options.margin = 0.6;
    StiffnessWatch watch = watchOf(options);
    CHECK(watch.springs().rotationalStiffness == doctest::Approx(12.0));
    run(watch, 0.0013, 2.0);
    CHECK(watch.springs().rotationalStiffness == doctest::Approx(12.0 / 1.3));
    run(watch, 0.002, 2.0);
    CHECK(watch.springs().rotationalStiffness == doctest::Approx(6.0));
    CHECK(watch.springs().stiffness == doctest::Approx(300.0));
}

TEST_CASE("One late tick lowers the stiffness by at most 40 %, and any stall leaves 1 % of it") {
    CouplingOptions options;
    StiffnessWatch watch = watchOf(options);
    run(watch, 0.001, 0.5);
    watch.step(0.01);
    run(watch, 0.001, 0.05);
    CHECK(watch.springs().stiffness >= 700.0 - 1e-9);
    for (int i = 0; i < 500; ++i) {
        watch.step(0.001);
        CHECK(watch.springs().stiffness >= 600.0);
    }
    for (int i = 0; i < 100; ++i) {
        watch.step(1800.0);
    }
    CHECK(watch.springs().stiffness == doctest::Approx(10.0));
    CHECK(watch.springs().rotationalStiffness > 0.0);
    CHECK(std::isfinite(watch.springs().metricRadius));
}

TEST_CASE("A tick that is late by itself is no slow rate, however late it is") {
    for (const double late : {0.03, 0.3, 3.0}) { // [s]
        CAPTURE(late);
        StiffnessWatch watch = watchOf({});
        run(watch, 0.001, 0.5);
        double before = watch.springs().stiffness;
        watch.step(late);
        for (int i = 0; i < 500; ++i) {
            CHECK(before - watch.springs().stiffness <= 1000.0 * 0.01 / StiffnessWatch::kDown + 1e-9);
            before = watch.springs().stiffness;
            CHECK(before >= 600.0);
            watch.step(0.001);
        }
        run(watch, 0.03, 2.0);
        CHECK(watch.springs().stiffness == doctest::Approx(1000.0 / 30.0));
    }
}

TEST_CASE("A user-given stiffness and a device with unknown b are not adapted") {
    CouplingOptions options;
    options.stiffness = 900.0;
    StiffnessWatch given = watchOf(options);
    run(given, 0.003, 2.0);
    CHECK(given.springs().stiffness == 900.0);
    StiffnessWatch unknown = watchOf(CouplingOptions{}, "touch");
    run(unknown, 0.003, 2.0);
    CHECK(unknown.springs().stiffness == 400.0);
}

TEST_CASE("The bound includes delay and the share of guidance") {
    CouplingOptions options;
    options.delayTicks = 1.0;
    options.paperGuidance = true;
    StiffnessWatch watch = watchOf(options);
    const Springs planned = watch.springs();
    CHECK(planned.stiffness + planned.guidanceStiffness == doctest::Approx(1000.0 / 3.0));
    run(watch, 0.002, 2.0);
    CHECK(watch.springs().stiffness == doctest::Approx(0.5 * planned.stiffness));
    CHECK(watch.springs().guidanceStiffness == doctest::Approx(0.5 * planned.guidanceStiffness));
}

TEST_CASE("The slew limits can follow the automatic stiffness at 0.25 m/s and 2.5 rad/s; a given one is not "
          "reduced") {
    CouplingOptions options;
    options.toolRadius = 1.0;
    options.slewForce = 100.0, options.slewTorque = 5.0;
    const Springs springs = makeSprings(devicePreset("ideal"), options);
    CHECK(springs.stiffness == doctest::Approx(400.0));
    CHECK(springs.rotationalStiffness == doctest::Approx(2.0));
    options.stiffness = 900.0;
    CHECK(makeSprings(devicePreset("ideal"), options).stiffness == 900.0);
}

TEST_CASE("Ticks of which every second one is late count as slow") {
    StiffnessWatch watch = watchOf(CouplingOptions{});
    for (int i = 0; i < 400; ++i) {
        watch.step(i % 2 == 0 ? 0.04 : 0.001);
    }
    CHECK(watch.period() > 0.03);
}
