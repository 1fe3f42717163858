// SPDX-License-Identifier: Apache-2.0
// The layout of the studies' plots: axes, panels, and labels that overlap nothing.
#include "apps/profile/plot_labels.h"
#include "apps/profile/study_plot.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>

using namespace fathom;
using namespace fathom::profile;

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

TEST_CASE("No label covers a line of its plot") {
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
