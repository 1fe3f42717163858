// SPDX-License-Identifier: Apache-2.0
// The arithmetic of the studies: percentiles, Pareto front, power law, boundary distance.
#include "apps/profile/interleave.h"
#include "apps/profile/region_boundary.h"
#include "apps/profile/study.h"
#include "engine/types/error.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::profile;

namespace {

StudyRow row(const char* setting, double error, double time, bool isDefault = false) {
    StudyRow r;
    r.source = std::string("s");
    r.setting = std::string(setting);
    r.error = error;
    r.isDefault = isDefault;
    r.cost.submit = {time, time, time, 5};
    return r;
}

RegionSpheres grid(int n, double spacing, double radius, int stride, double grown) {
    RegionSpheres s;
    for (int j = 0; j <= n; j += stride) {
        for (int i = 0; i <= n; i += stride) {
            s.add({i * spacing, j * spacing, 0.0}, radius + grown, static_cast<uint32_t>(j * (n + 1) + i));
        }
    }
    return s;
}

} // namespace

TEST_CASE("Percentiles are nearest-rank values of the input in any order") {
    CHECK(spreadOf({}).count == 0);
    CHECK(!spreadOf({}));
    const Spread one = spreadOf({3.0});
    CHECK(one.p50 == 3.0);
    CHECK(std::isnan(one.p99)); // by rank it would be the largest
    std::vector<double> values;
    for (int i = 200; i >= 1; --i) {
        values.push_back(i);
    }
    const Spread many = spreadOf(values);
    CHECK(many.p50 == 100.0);
    CHECK(many.p90 == 180.0);
    CHECK(many.p99 == 198.0);
    CHECK(many.count == 200);
    values.resize(100);
    CHECK(spreadOf(values).p99 == 199.0);
    values.pop_back();
    CHECK(std::isnan(spreadOf(values).p99));
}

TEST_CASE("The front has exactly the settings that no other beats in both error and time") {
    Study study;
    study.rows = {row("quick", 3.0, 1.0), row("good", 1.0, 2.0), row("bad", 2.0, 3.0), row("best", 0.5, 9.0),
                  row("unmeasured", NAN, 0.1)};
    markFront(study);
    CHECK(study.rows[0].onFront);
    CHECK(study.rows[1].onFront);
    CHECK(!study.rows[2].onFront);
    CHECK(study.rows[3].onFront);
    CHECK(!study.rows[4].onFront);
}

TEST_CASE(
    "A default off the front is reported with the setting that beats it and the reason, unless within 5 %") {
    Study study;
    study.errorUnit = "mm";
    study.rankBy.reason = "because";
    study.rows = {row("good", 1.0, 2.0), row("mine", 2.0, 3.0, true)};
    markFront(study);
    REQUIRE(study.findings.size() == 1);
    CHECK(study.findings[0] == "default 'mine' on s is off the front: 'good' has 1 against 2 mm at 2 against "
                               "3 ms; it stays the default: because");
    study.findings.clear();
    study.rows = {row("good", 1.0, 2.0), row("mine", 1.0, 2.05, true)};
    markFront(study);
    CHECK(study.findings[0] == "default 'mine' on s lies on the Pareto front");
}

TEST_CASE("A study with different errors and times per source ranks each source by its own values and unit") {
    Study study;
    study.errorUnit = "count";
    study.rankBy.reason = "because";
    study.rows = {row("ours", NAN, 2.0, true), row("theirs", NAN, 1.0)};
    study.rows[0].cost.cpu = {0.5, 0.5, 0.5, 5}, study.rows[1].cost.cpu = {0.4, 0.4, 0.4, 5};
    study.rows[0].more = {3.0}, study.rows[1].more = {2.0};
    study.rankBy.time = cpuTime;
    study.rankBy.error = [](const StudyRow& r) { return r.more[0]; };
    study.rankBy.errorUnit = [](const StudyRow&) { return "mm"; };
    markFront(study);
    REQUIRE(study.verdicts.size() == 1);
    CHECK(
        study.verdicts[0].words ==
        "is off the front: 'theirs' has 2 against 3 mm at 0.4 against 0.5 ms; it stays the default: because");
    CHECK(!study.verdicts[0].onFront);
    CHECK(study.rows[1].onFront);
    study.verdicts.clear();
    study.rows[1].more = {3.1}; // larger error
    markFront(study);
    CHECK(study.verdicts[0].onFront);
    CHECK(study.verdicts[0].words == "lies on the Pareto front");
}

TEST_CASE("A default without an error is not reported as on the front") {
    Study study;
    study.rows = {row("mine", NAN, 2.0, true), row("other", 1.0, 3.0)};
    markFront(study);
    REQUIRE(study.verdicts.size() == 1);
    CHECK(!study.verdicts[0].onFront);
    CHECK(study.verdicts[0].words == "is not judged: it has no error or no time on this source");
}

TEST_CASE("A study with its own ranking time is judged by it") {
    Study study;
    study.rankBy.time = [](const StudyRow& r) { return r.more[0]; };
    study.rows = {row("slow", 2.0, 1.0), row("quick", 2.0, 3.0)};
    study.rows[0].more = {7.0};
    study.rows[1].more = {4.0};
    markFront(study);
    CHECK(!study.rows[0].onFront);
    CHECK(study.rows[1].onFront);
    const PlotPanel panel = frontPanel(study, "drawn by the same");
    CHECK(panel.series.front().points.front().x == 7.0);
    CHECK(panel.series.front().points.back().isFront);
}

TEST_CASE("Without timestamps, a row's device time is the time from submission to result") {
    StudyRow r = row("any", 1.0, 5.0);
    CHECK(gpuTime(r) == 5.0);
    r.cost.gpu = {2.0, 2.0, 2.0, 5};
    CHECK(gpuTime(r) == 2.0);
    CHECK(submitTime(r) == 5.0);
}

TEST_CASE("Interleaved settings all run in every round, and none is always first") {
    std::vector<size_t> order;
    double seconds = 0.0;
    interleave({8, 40, 2.0}, 3, [&](size_t i, const Repeats& part) {
        order.push_back(i);
        seconds += part.seconds;
        CHECK(part.least == 2);
        CHECK(part.most == 10);
    });
    CHECK(order == std::vector<size_t>{0, 1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0});
    CHECK(seconds == doctest::Approx(3 * 2.0));
}

TEST_CASE("Interleaved loops alternate, and each keeps the samples of all its rounds") {
    std::vector<char> calls;
    const std::vector<Cost> costs =
        timeCpuInterleaved({4, 4, 0.0}, {[&] { calls.push_back('a'); }, [&] { calls.push_back('b'); }});
    REQUIRE(costs.size() == 2);
    CHECK(costs[0].cpu.count == 4);
    CHECK(costs[1].submit.count == 4);
    // Each round has one warm-up call and one sample.
    CHECK(std::string(calls.begin(), calls.end()) == "aabbbbaaaabbbbaa");
}

TEST_CASE("A power law is recovered from its points, and fewer than two points give none") {
    std::vector<PlotPoint> points;
    for (double x : {1.0, 3.0, 10.0, 70.0}) {
        points.push_back({x, 0.2 * std::pow(x, 1.5), "", false, false});
    }
    points.push_back({5.0, 0.0, "", false, false}); // has no logarithm, is skipped
    const auto law = fitPower(points);
    REQUIRE(law);
    CHECK(law->exponent == doctest::Approx(1.5));
    CHECK(law->factor == doctest::Approx(0.2));
    CHECK(!fitPower({}));
    CHECK(!fitPower({{1.0, 1.0, "", false, false}}));
    CHECK(!fitPower({{2.0, 1.0, "", false, false}, {2.0, 3.0, "", false, false}}));
}

TEST_CASE("A wrong result throws an error that names study and setting") {
    CHECK_NOTHROW(profile::verify(true, "query", "x", "y"));
    CHECK_THROWS_WITH_AS(profile::verify(false, "query", "GPU 4", "overflow"),
                         "profile query: 'GPU 4' is wrong and was not timed: overflow", Error);
}

TEST_CASE("Equal regions have no boundary error, and a shrunken region is detected") {
    const RegionSpheres all = grid(20, 0.004, 0.02, 1, 0.0);
    const BoundaryError same = boundaryError(all, all, 200, 3);
    CHECK(same.max < 1e-6);
    CHECK(same.worstInside < 1e-6);
    CHECK(same.samples == 200);
    const BoundaryError shrunk = boundaryError(all, grid(20, 0.004, 0.02, 4, 0.0), 400, 3);
    CHECK(shrunk.worstInside > 5e-4);
}

TEST_CASE("Thinned spheres that grow enough cover the region, and the error is at most the growth") {
    const double radius = 0.02, spacing = 0.004,
                 grown = std::sqrt(radius * radius + 2 * 0.008 * 0.008) - radius;
    const BoundaryError error =
        boundaryError(grid(20, spacing, radius, 1, 0.0), grid(20, spacing, radius, 4, grown), 400, 5);
    CHECK(error.worstInside <= 1e-7);
    CHECK(error.max > 0.5 * grown);
    CHECK(error.max <= grown + 1e-7);
    CHECK(error.rms < error.max);
}
