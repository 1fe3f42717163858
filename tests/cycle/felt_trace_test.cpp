// SPDX-License-Identifier: Apache-2.0
#include "apps/verify/felt_trace.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace fathom;

namespace {

// 2 s of 5 N plus 0.3 N at 20 Hz and 0.1 N at 200 Hz along x; the hand swings by 1 mm at 12 Hz.
FeltTrace twoTones() {
    FeltTrace trace;
    for (int k = 0; k < 2000; ++k) {
        const double t = 0.001 * k, turn = 2.0 * std::numbers::pi * t;
        const double x = 5.0 + 0.3 * std::sin(20.0 * turn) + 0.1 * std::cos(200.0 * turn);
        trace.add({dvec3(x, 0.0, 0.0), dvec3(0.0, 0.02 * std::sin(3.0 * turn), 0.0)},
                  dvec3(0.0, 0.001 * std::sin(12.0 * turn), 0.0));
    }
    return trace;
}

} // namespace

TEST_CASE("A trace of two tones has their RMS in their bands, and nothing between") {
    const FeltTrace trace = twoTones();
    const double half = std::sqrt(0.5);
    CHECK(trace.meanForce().x == doctest::Approx(5.0));
    CHECK(trace.forceRms() == doctest::Approx(half * std::hypot(0.3, 0.1)));
    CHECK(trace.forceBand(10.0, 35.0) == doctest::Approx(0.3 * half));
    CHECK(trace.forceBand(100.0, 500.0) == doctest::Approx(0.1 * half));
    CHECK(trace.forceBand(40.0, 100.0) < 1e-9);
    CHECK(trace.torqueRms() == doctest::Approx(0.02 * half));
    CHECK(trace.motionBand(10.0, 35.0) == doctest::Approx(0.001 * half));
    CHECK(trace.motionPeakToPeak() == doctest::Approx(0.002));
    CHECK(trace.sawtooth({1.0, 0.0, 0.0}, 0.1) == doctest::Approx(0.4).epsilon(0.05));
}

TEST_CASE("Steps, reversals and rises of a force are counted tick by tick") {
    FeltTrace trace;
    for (const double force : {0.0, 1.0, 0.5, 0.6, 2.7, 2.7, 2.0}) {
        trace.add({dvec3(0.0, 0.0, force), dvec3(0.0)}, dvec3(0.0));
    }
    CHECK(trace.forceStep() == doctest::Approx(2.1));
    CHECK(trace.stepsOver(0.9) == 2);
    CHECK(trace.reversals(0.3) == 1); // 0 1 0.5
    CHECK(trace.steepestRise(0.001) == doctest::Approx(2100.0));
    CHECK(trace.steepestRise(0.002) == doctest::Approx(1100.0));
    trace.clear();
    CHECK(trace.ticks() == 0);
    CHECK(trace.forceRms() == 0.0);
}
