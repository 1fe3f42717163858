// SPDX-License-Identifier: Apache-2.0
// The figures of force and torque in bars and traces: delivered, residual, peak, ripple.
#include "apps/operate/wrench_figures.h"
#include "tests/apps/viewed_run.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::operate;

namespace {

std::array<WrenchFigures, 2> figures(const ViewedRun& run) {
    return figuresOf(run.view, run.haptics);
}

// `frames` frames of 33 ticks with the force of force(frame, tick).
template <class Force>
void play(ViewedRun& run, int frames, Force&& force) {
    for (int frame = 0; frame < frames; ++frame) {
        ++run.row.record.frame;
        for (int tick = 0; tick < 33; ++tick) {
            run.row.record.wrench.force = force(frame, tick);
            run.step(0.001);
        }
    }
}

} // namespace

TEST_CASE("Force and torque are what the device renders, and the rest is the residual") {
    ViewedRun run;
    run.haptics.forceLimit = 10.0, run.haptics.torqueLimit = 0.2;
    run.row.record.wrench = {{3.0, 0.0, 4.0}, {0.0, 0.15, 0.0}};
    run.row.record.residual = {{0.0, 0.0, 0.0}, {0.0, 0.15, 0.0}}; // no torque motors
    run.step(0.001);
    const auto [force, torque] = figures(run);
    CHECK(force.delivered == doctest::Approx(5.0));
    CHECK_FALSE(force.renderedInPart());
    CHECK(torque.delivered == 0.0);
    CHECK(torque.residual == doctest::Approx(0.15));
    CHECK(torque.whole == doctest::Approx(0.15));
    CHECK(torque.renderedInPart());
    CHECK_FALSE(torque.saturated());
    run.row.record.residual.force = dvec3(kNotKnown); // an older recording
    run.step(0.001);
    CHECK(figures(run)[0].delivered == doctest::Approx(5.0));
    CHECK(std::isnan(figures(run)[0].residual));
}

TEST_CASE("A peak is held for the ten seconds of the trace") {
    ViewedRun run;
    run.row.record.wrench.force = {7.0, 0.0, 0.0};
    run.step(0.001);
    run.row.record.wrench.force = {1.0, 0.0, 0.0};
    run.step(5.0);
    CHECK(figures(run)[0].delivered == doctest::Approx(1.0));
    CHECK(figures(run)[0].peak == doctest::Approx(7.0));
    run.step(5.1);
    CHECK(figures(run)[0].peak == doctest::Approx(1.0));
}

TEST_CASE(
    "The ripple is the RMS change from frame to frame, without the motion of the hand, over one second") {
    ViewedRun run;
    CHECK(std::isnan(figures(run)[0].ripple));
    play(run, 40, [](int frame, int tick) { return dvec3(2.0 + 0.1 * frame + 0.003 * tick, 0.0, 0.0); });
    CHECK(figures(run)[0].ripple < 1e-3); // the hand presses harder and harder
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.05);
    dvec3 error(0.0);
    double sum = 0.0;
    const auto noisy = [&](int, int tick) {
        error = tick == 0 ? dvec3(noise(random), noise(random), noise(random)) : error;
        return dvec3(5.0, 0.0, 0.0) + error;
    };
    for (int i = 0; i < 100; ++i) {
        play(run, 30, noisy);
        sum += figures(run)[0].ripple;
    }
    CHECK(sum / 100 == doctest::Approx(0.05 * std::sqrt(3.0)).epsilon(0.05));
    play(run, 40, [](int, int) { return dvec3(5.0, 0.0, 0.0); });
    CHECK(figures(run)[0].ripple < 1e-6);
}
