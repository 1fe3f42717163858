// SPDX-License-Identifier: Apache-2.0
// The arithmetic of the studies: percentiles, Pareto front, power law, boundary distance, plot layout.
#include "apps/profile/interleave.h"
#include "apps/profile/plot_labels.h"
#include "apps/profile/region_boundary.h"
#include "apps/profile/study_plot.h"
#include "engine/types/error.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>

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

TEST_CASE("A logarithmic axis keeps the order of its values and shows zeros separately at its low end") {
    const PanelAxis axis = panelAxis({0.0, 0.01, 0.5, 20.0}, true, 100.0, 500.0);
    CHECK(axis.at(0.0) > 100.0);
    CHECK(axis.at(0.0) < axis.at(0.01));
    CHECK(axis.at(0.01) < axis.at(0.5));
    CHECK(axis.at(20.0) < 500.0);
    CHECK(axis.ticks().front().label == "0");
    for (const PanelAxis::Tick& tick : axis.ticks()) {
        CHECK(axis.at(tick.value) >= 100.0);
        CHECK(axis.at(tick.value) <= 500.0);
    }
    CHECK(panelAxis({}, true, 0.0, 1.0).ticks().size() >= 1);
    for (double low : {0.0091, 0.013, 0.47, 3.3, 7.6}) { // a short axis also has ticks
        const PanelAxis brief = panelAxis({low, 1.1 * low}, true, 0.0, 100.0);
        CHECK(brief.ticks().size() >= 2);
        CHECK(brief.ticks().size() <= 6);
    }
    CHECK(panelAxis({5.0, 5.0}, true, 0.0, 1.0).at(5.0) == doctest::Approx(0.5));
}

TEST_CASE("Every point of a crowded panel gets a label that overlaps no other label, point or border") {
    const PlotBox room{80.0, 100.0, 700.0, 560.0};
    std::vector<LabelRequest> requests;
    std::vector<PlotBox> points;
    for (int i = 0; i < 70; ++i) { // a cluster, and some points at the borders
        const int across = i % 10, down = i / 10;
        const double x = i < 60 ? 300.0 + 7.0 * across : 85.0 + 68.0 * (i - 60),
                     y = i < 60 ? 200.0 + 6.0 * down : (i % 2 == 0 ? 104.0 : 556.0);
        requests.push_back({x, y, 90.0});
        points.push_back({x - 4.0, y - 4.0, x + 4.0, y + 4.0});
    }
    const std::vector<LabelPlace> places = placeLabels(requests, room, points);
    REQUIRE(places.size() == requests.size());
    size_t led = 0;
    for (size_t i = 0; i < places.size(); ++i) {
        CAPTURE(i);
        const PlotBox& box = places[i].box;
        led += places[i].beside ? 0 : 1;
        CHECK((box.x0 > room.x0 && box.x1 < room.x1 && box.y0 > room.y0 && box.y1 < room.y1));
        for (size_t k = 0; k < i; ++k) {
            CHECK(!box.meets(places[k].box));
        }
        for (const PlotBox& point : points) {
            CHECK(!box.meets(point));
        }
    }
    CHECK(led > 20);
    CHECK(led < 65);
    const auto alone = placeLabels({{400.0, 300.0, 90.0}}, room, {{396.0, 296.0, 404.0, 304.0}});
    CHECK(alone.front().beside);
}

TEST_CASE("Labels lie on no line of their plot") {
    const PlotBox room{0.0, 0.0, 600.0, 400.0};
    const std::vector<glm::dvec2> corners{{20.0, 50.0},   {200.0, 50.0},  {200.0, 200.0},
                                          {320.0, 200.0}, {320.0, 330.0}, {560.0, 380.0}};
    std::vector<PlotBox> taken;
    for (size_t i = 1; i < corners.size(); ++i) {
        addLine(corners[i - 1], corners[i], taken);
    }
    std::vector<LabelRequest> requests;
    for (const glm::dvec2& corner : corners) {
        requests.push_back({corner.x, corner.y, 80.0});
    }
    for (const LabelPlace& place : placeLabels(requests, room, taken)) {
        CAPTURE(place.x);
        for (size_t i = 1; i < corners.size(); ++i) {
            for (double share = 0.0; share <= 1.0; share += 1.0 / 512.0) {
                const glm::dvec2 at = glm::mix(corners[i - 1], corners[i], share);
                CHECK(!place.box.meets({at.x, at.y, at.x + 1e-9, at.y + 1e-9}));
            }
        }
    }
}

TEST_CASE("A name shared by points in one place is drawn once, and again for a distant point") {
    const std::vector<LabelRequest> requests = {{100.0, 50.0, 90.0, "reach 10 mm"},
                                                {104.0, 53.0, 90.0, "reach 10 mm"},
                                                {102.0, 50.0, 90.0, "reach 20 mm"},
                                                {100.0, 80.0, 90.0, "reach 10 mm"}};
    CHECK(distinctLabels(requests) == std::vector<size_t>{0, 2, 3});
    CHECK(distinctLabels({}).empty());
}

TEST_CASE("Panels are in one row while they stay readable, otherwise in two, without overlap") {
    for (size_t panels = 0; panels < 9; ++panels) {
        CAPTURE(panels);
        const PanelGrid grid = panelGrid(panels);
        CHECK(static_cast<size_t>(grid.across * grid.down) >= panels);
        CHECK(grid.down == (panels > 3 ? 2 : 1));
        CHECK((panels < 2 || static_cast<size_t>((grid.across - 1) * grid.down) < panels)); // no empty column
    }
}

TEST_CASE("Without a free place, a label is still drawn next to its point") {
    const auto places =
        placeLabels({{50.0, 50.0, 90.0}}, {0.0, 0.0, 100.0, 100.0}, {{0.0, 0.0, 100.0, 100.0}});
    REQUIRE(places.size() == 1);
    CHECK(places.front().beside);
    CHECK(places.front().x == doctest::Approx(61.0));
}
