// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/traces_plot.h"

#include "apps/output/image.h"
#include "apps/output/plot_axis.h"
#include "apps/replay/trace_phases.h"
#include "apps/replay/traces_style.h"
#include "engine/types/error.h"
#include "tests/apps/png_image.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

StepRecord tickAt(int i, double force, StepState state = StepState::Free) {
    StepRecord tick;
    tick.t = i * 0.001;
    tick.wrench.force = {0.0, force, 0.0};
    tick.wrench.torque = {0.1 * force, 0.0, 0.0};
    tick.deviceWrench = tick.wrench;
    tick.state = state;
    tick.frame = i / 33;
    return tick;
}

// Highest dark pixel of column u between the rows, or -1.
int topInk(const PngImage& image, int u, int from, int to) {
    for (int v = from; v < to; ++v) {
        if (image.red(u, v) < 90 && image.blue(u, v) < 110) {
            return v;
        }
    }
    return -1;
}

} // namespace

TEST_CASE("A long run keeps its peaks, its tick count and its frame count in constant memory") {
    TraceHistory history(64);
    const int count = 100003;
    for (int i = 0; i < count; ++i) {
        history.add(tickAt(i, i == 77777 ? 9.0 : 1.0 + (i % 7 == 0 ? 0.5 : 0.0)));
    }
    CHECK(history.bins().size() <= 64);
    CHECK(history.bins().size() >= 32);
    CHECK(history.ticks() == count);
    CHECK(history.newFrames() == (count + 32) / 33);
    CHECK(history.forcePeak().value == 9.0);
    CHECK(history.forcePeak().t == doctest::Approx(77.777));
    uint64_t ticks = 0, frames = 0;
    double highest = 0.0, previous = -1.0;
    for (const TraceBin& bin : history.bins()) {
        ticks += bin.ticks;
        frames += bin.newFrames;
        highest = std::max(highest, bin.forceMax);
        CHECK(bin.forceMin == 1.0);
        CHECK(bin.begin > previous);
        CHECK((bin.forceMax == 9.0) == (bin.begin <= 77.777 && bin.end >= 77.7769));
        previous = bin.end;
    }
    CHECK(ticks == count);
    CHECK(frames == history.newFrames());
    CHECK(highest == 9.0);
}

TEST_CASE("Values that are not finite leave a gap and never a number") {
    TraceHistory history(4);
    for (int i = 0; i < 9; ++i) {
        StepRecord tick = tickAt(i, 1.0);
        tick.deviceWrench.force.x = i < 4 ? std::nan("") : 0.0;
        history.add(tick);
    }
    CHECK(history.bins().front().forceMax < history.bins().front().forceMin);
    CHECK(history.bins().front().torqueMax == doctest::Approx(0.1));
    CHECK(history.bins().back().forceMax == 1.0);
    CHECK(history.forcePeak().value == 1.0);
}

TEST_CASE("Phases follow the states, merge flicker into their neighbours, and prefer guidance to contact") {
    TraceHistory history;
    for (int i = 0; i < 4000; ++i) {
        const bool touching = (i >= 1000 && i < 2000 && i % 200 >= 20) || i >= 3500;
        StepRecord tick = tickAt(i, touching ? 3.0 : 0.0, touching ? StepState::Contact : StepState::Free);
        tick.guidance = i >= 3000 ? 0.5 : 0.0;
        history.add(tick);
    }
    const auto phases = findPhases(history);
    REQUIRE(phases.size() == 4);
    CHECK(phases[0].kind == PhaseKind::Free);
    CHECK(phases[1].kind == PhaseKind::Contact);
    CHECK(phases[1].begin == doctest::Approx(1.0).epsilon(0.01));
    CHECK(phases[1].end == doctest::Approx(2.0).epsilon(0.01));
    CHECK(phases[2].kind == PhaseKind::Free);
    CHECK(phases[3].kind == PhaseKind::Guidance);
    CHECK(phases[3].end == doctest::Approx(3.999));
    CHECK(findPhases(TraceHistory{}).empty());
}

TEST_CASE("A run of many changes has no more phases than letters, without gaps, and covers the run") {
    TraceHistory history;
    for (int i = 0; i < 50000; ++i) {
        history.add(tickAt(i, 0.0, i / 700 % 2 == 0 ? StepState::Free : StepState::Contact));
    }
    const auto phases = findPhases(history);
    CHECK(phases.size() <= 26);
    CHECK(!phases.empty());
    CHECK(phases.front().begin == 0.0);
    CHECK(phases.back().end == doctest::Approx(49.999));
    for (size_t i = 1; i < phases.size(); ++i) {
        CHECK(phases[i].begin == phases[i - 1].end);
        CHECK(phases[i].kind != phases[i - 1].kind);
    }
}

TEST_CASE("Axis steps are 1, 2 or 5 times a power of ten, and labels have the digits that the step needs") {
    for (const double range : {1e-6, 0.003, 0.7, 1.0, 9.99, 60.0, 3600.0}) {
        const double step = roundStep(range, 8);
        const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
        CHECK(range / step <= 8.0 + 1e-6);
        CHECK(range / step > 3.0);
        CHECK((std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
               std::abs(mantissa - 5) < 1e-6));
    }
    const auto ticks = ticksOf({0.0, 0.6, 0.0, 100.0}, 6);
    REQUIRE(ticks.size() == 7);
    CHECK(ticks[0].label == "0.0");
    CHECK(ticks[3].label == "0.3");
    CHECK(ticksOf({0.0, 3600.0, 0.0, 1.0}, 12).back().label == "3500");
    CHECK(shortNumber(0.0) == "0.000");
    CHECK(shortNumber(7.3149) == "7.315");
    CHECK(shortNumber(1234.56) == "1235");
    CHECK(shortNumber(0.01234) == "0.0123");
    CHECK(roundNumber(20.0) == "20");
}

TEST_CASE("The force trace follows the scale of its axis over 1 s and 1 h, and one tick gives an image of "
          "the usual size") {
    const ScratchFolder folder;
    const auto path = folder.path() / "traces.png";
    for (const int count : {1, 1000, 3600000}) {
        TraceHistory history;
        for (int i = 0; i < count; ++i) {
            history.add(tickAt(i, 2 * i < count - 1 ? 4.0 : i % 2 == 0 ? 8.0 : 6.0)); // axis to 10 N
        }
        std::filesystem::remove(path); // read below, and inputs are never replaced
        drawTraces(history, {"title", "subtitle", 20.0, 0.9}).writePng(path);
        const PngImage image(path);
        REQUIRE(image.width() == traces::kWidth);
        REQUIRE(image.height() == traces::kHeight);
        const int top = static_cast<int>(traces::kForceTop), bottom = static_cast<int>(traces::kForceBottom);
        const double newton = (traces::kForceBottom - traces::kForceTop) / 10.0;
        const int late = static_cast<int>(traces::kLeft + 0.9 * (traces::kRight - traces::kLeft));
        const int early = static_cast<int>(traces::kLeft + 0.3 * (traces::kRight - traces::kLeft));
        if (count > 1) {
            int highest = bottom; // in a short run a column may be between two ticks
            for (int u = late; u < late + 6; ++u) {
                highest = std::min(highest, topInk(image, u, top, bottom - 10));
            }
            CHECK(std::abs(highest - (bottom - 8.0 * newton)) <= 3.0);
            CHECK(std::abs(topInk(image, early, top, bottom - 10) - (bottom - 4.0 * newton)) <= 3.0);
        }
    }
}

TEST_CASE("Escapes of single ticks are marks at the axis, and only a part that escapes most of the time is "
          "hatched") {
    const ScratchFolder folder;
    for (const int count : {1000, 17960, 400000}) { // of many columns per tick, and many ticks per column
        CAPTURE(count);
        TraceHistory history;
        for (int i = 0; i < count; ++i) {
            const bool single = i % 40 == 0, trapped = i > count * 8 / 10 && i < count * 9 / 10;
            const bool escape = single && i > count / 10 && i < count / 2;
            history.add(tickAt(i, 8.0,
                               trapped  ? StepState::Trapped
                               : escape ? StepState::Escape
                                        : StepState::Contact));
        }
        const auto path = folder.path() / ("traces" + std::to_string(count) + ".png");
        drawTraces(history, {"title", "subtitle", 20.0, 2.0}).writePng(path);
        const PngImage image(path);
        const auto redPixels = [&](double from, double to, int top, int bottom) { // of shares of the run
            const double wide = traces::kRight - traces::kLeft;
            int found = 0;
            for (int u = static_cast<int>(traces::kLeft + from * wide); u < traces::kLeft + to * wide; ++u) {
                for (int v = top; v < bottom; ++v) {
                    found += image.red(u, v) > image.blue(u, v) + 90 && image.red(u, v) > 180 ? 1 : 0;
                }
            }
            return found;
        };
        const int top = static_cast<int>(traces::kForceTop), bottom = static_cast<int>(traces::kForceBottom);
        CHECK(redPixels(0.12, 0.48, top, bottom - 40) == 0);
        CHECK(redPixels(0.12, 0.48, bottom - 40, bottom) > 100);
        CHECK(redPixels(0.52, 0.78, top, bottom) == 0);
        CHECK(redPixels(0.82, 0.88, top, bottom - 40) > 1000);
    }
}

TEST_CASE("An empty run, a run of zeros and a run of NaN give an image without a trace") {
    const ScratchFolder folder;
    TraceHistory zeros, nothing;
    for (int i = 0; i < 500; ++i) {
        zeros.add(tickAt(i, 0.0));
        nothing.add(tickAt(i, std::nan("")));
    }
    for (const TraceHistory& history : {TraceHistory{}, zeros, nothing}) {
        const auto path = folder.path() / "traces.png";
        std::filesystem::remove(path); // read below, and inputs are never replaced
        drawTraces(history, {"t", "bad \xff byte", std::nullopt, std::nan("")}).writePng(path);
        const PngImage image(path);
        CHECK(image.width() == 1600);
        CHECK(topInk(image, static_cast<int>(traces::kLeft) + 300, 160, 300) == -1);
    }
    CHECK(folder.files() == 1);
    CHECK_THROWS_AS(drawTraces(zeros, {}).writePng(folder.path() / "none" / "a.png"), Error);
}
