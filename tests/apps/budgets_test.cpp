// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/budgets.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

ReplaySummary summaryWith(double forbiddenPoints) {
    ReplaySummary s;
    s.frames.latencyMs.p50 = 9.0;
    s.haptic.stepMicros.p50 = 12.0;
    s.haptic.stepMicros.p99 = 90.0;
    s.fixtures.push_back({"valve", "forbidden", forbiddenPoints, 0.0, 0.0});
    s.fixtures.push_back({"target", "guidance", 100000.0, 0.0, 0.0});
    return s;
}

Intrinsics image(uint32_t width, uint32_t height) {
    Intrinsics lens;
    lens.width = width;
    lens.height = height;
    return lens;
}

} // namespace

TEST_CASE(
    "A frame over its budget and a tick over its p99 are reported as missed, a tick within its p50 as met") {
    const auto figures = budgetFigures(summaryWith(20000.0), image(640, 480), DeviceKind::Cpu, 8);
    REQUIRE(figures.size() == 3);
    CHECK(figures[0].budget == 8.0);
    CHECK_FALSE(figures[0].holds());
    CHECK(figures[1].holds());
    CHECK_FALSE(figures[2].holds());
}

TEST_CASE("The budget depends on the share of forbidden pixels, the size and the device") {
    CHECK(budgetFigures(summaryWith(40000.0), image(640, 480), DeviceKind::Cpu, 8)[0].budget == 20.0);
    CHECK(budgetFigures(summaryWith(0.0), image(640, 480), DeviceKind::Discrete, 8)[0].budget == 0.090);
    CHECK(budgetFigures(summaryWith(0.0), image(1280, 720), DeviceKind::Cpu, 8)[0].budget == 60.0);
    CHECK(budgetFigures(summaryWith(0.0), image(428, 240), DeviceKind::Cpu, 8).size() == 2);
    CHECK(budgetFigures(summaryWith(0.0), image(640, 480), DeviceKind::Other, 8).size() == 2);
}

TEST_CASE("The first frame has a budget on CPU devices") {
    ReplaySummary summary = summaryWith(0.0);
    summary.frames.first = 3.1;
    const auto figures = budgetFigures(summary, image(640, 480), DeviceKind::Cpu, 8);
    REQUIRE(figures.size() == 4);
    CHECK(figures[3].unit == std::string("s"));
    CHECK_FALSE(figures[3].holds());
    CHECK(budgetFigures(summary, image(640, 480), DeviceKind::Discrete, 8).size() == 3);
}

TEST_CASE("A figure that was not measured has no budget line") {
    CHECK(budgetFigures(ReplaySummary{}, image(640, 480), DeviceKind::Cpu, 8).empty());
}

TEST_CASE("The budget of a tick states the tool's number of leaves and the number that it assumes") {
    const auto figures = budgetFigures(summaryWith(0.0), image(640, 480), DeviceKind::Other, 8);
    REQUIRE(figures.size() == 2);
    CHECK(figures[0].what == "step p50");
    CHECK(figures[1].what == "step p99");
    CHECK(figures[0].note == "8 leaves; the budget is for 256 leaves in contact with 60 000 spheres");
    CHECK(figures[1].note == figures[0].note);
    CHECK(budgetFigures(summaryWith(0.0), image(640, 480), DeviceKind::Other, 1)[0].note.find("1 leaf; ") !=
          std::string::npos);
}
