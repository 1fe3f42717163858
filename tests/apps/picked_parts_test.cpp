// SPDX-License-Identifier: Apache-2.0
// Which connected parts a pick takes, and the box that limits it to them.
#include "apps/operate/picked_parts.h"
#include "tests/apps/flat_wall.h"
#include "tests/apps/viewed_run.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

namespace {

using Selection = std::vector<uint8_t>;

void fill(Selection& selection, uint32_t u0, uint32_t v0, uint32_t u1, uint32_t v1) {
    for (uint32_t v = v0; v < v1; ++v) {
        std::fill(selection.begin() + v * 64 + u0, selection.begin() + v * 64 + u1, uint8_t{1});
    }
}

size_t pointsOf(const Selection& selection) {
    return static_cast<size_t>(std::count(selection.begin(), selection.end(), uint8_t{1}));
}

// Two squares, 100 and 64 points, and a speck of 4.
Selection twoSquares() {
    Selection selection(size_t{64} * 48, 0);
    fill(selection, 4, 4, 14, 14);
    fill(selection, 40, 4, 48, 12);
    fill(selection, 25, 40, 27, 42);
    return selection;
}

constexpr double kEdge = 0.05;

} // namespace

TEST_CASE("A pick takes the part that was clicked, or the nearest one, with a box around it") {
    const HostFixtures set = flatWall();
    Selection selection = twoSquares();
    const PickedParts clicked = takeParts(selection, set, {44, 8}, {}, kEdge);
    CHECK(clicked.parts == 3);
    CHECK(clicked.taken == 1);
    CHECK(clicked.specks == 1);
    CHECK(clicked.others == 0);
    CHECK(pointsOf(selection) == 64);
    CHECK(selection[4 * 64 + 40] == 1);
    REQUIRE(clicked.box);
    CHECK(clicked.box->min.x == doctest::Approx((40 - 31.5) / 60.0 - 0.02).epsilon(1e-5)); // 20 mm of room
    CHECK(clicked.box->max.y == doctest::Approx((11 - 23.5) / 60.0 + 0.02).epsilon(1e-5));
    CHECK(clicked.box->max.z == doctest::Approx(1.02).epsilon(1e-5));
    Selection beside = twoSquares();
    (void)takeParts(beside, set, {17, 20}, {}, kEdge);
    CHECK(pointsOf(beside) == 100);
    Selection speck = twoSquares(); // not the speck, although it was clicked
    (void)takeParts(speck, set, {25, 40}, {}, kEdge);
    CHECK(speck[40 * 64 + 25] == 0);
    CHECK(pointsOf(speck) == 100);
}

TEST_CASE(
    "Without the rule of the click all parts but specks are taken; without both rules there is no box") {
    const HostFixtures set = flatWall();
    Selection selection = twoSquares();
    const PickedParts large =
        takeParts(selection, set, {44, 8}, {.onlyClicked = false, .noSpecks = true}, kEdge);
    CHECK(large.taken == 2);
    CHECK(pointsOf(selection) == 164);
    Selection all = twoSquares();
    const PickedParts every = takeParts(all, set, {44, 8}, {.onlyClicked = false, .noSpecks = false}, kEdge);
    CHECK(every.taken == 3);
    CHECK(!every.box);
    CHECK(pointsOf(all) == 168);
    Selection specks(size_t{64} * 48, 0);
    fill(specks, 25, 40, 27, 42);
    CHECK(takeParts(specks, set, {25, 40}, {}, kEdge).taken == 1); // nothing but specks
    CHECK(pointsOf(specks) == 4);
    Selection none(size_t{64} * 48, 0);
    CHECK(takeParts(none, set, {25, 40}, {}, kEdge).parts == 0);
}

TEST_CASE("Points of other parts inside the box stay selected and are counted, and a jump of depth parts") {
    HostFixtures set = flatWall();
    Selection selection(size_t{64} * 48, 0);
    fill(selection, 4, 4, 30, 6); // a corner ...
    fill(selection, 4, 4, 6, 30);
    fill(selection, 20, 20, 24, 24); // ... and a square inside the box around it
    const PickedParts corner = takeParts(selection, set, {4, 4}, {}, kEdge);
    CHECK(corner.parts == 2);
    CHECK(corner.others == 16);
    CHECK(pointsOf(selection) == 26 * 2 + 24 * 2 + 16);
    Selection square(size_t{64} * 48, 0);
    fill(square, 10, 10, 20, 20);
    for (uint32_t v = 10; v < 20; ++v) { // its right half is 300 mm nearer
        std::fill(set.depth.begin() + v * 64 + 15, set.depth.begin() + v * 64 + 20, uint16_t{700});
    }
    CHECK(takeParts(square, set, {11, 11}, {}, kEdge).parts == 2);
    CHECK(pointsOf(square) == 50);
}

TEST_CASE("An alarm says when more than a tenth of a class's points are at the side of its box") {
    ViewedRun run;
    run.alarms = Alarms(0.0); // at once
    run.scene.fixtures.resize(1);
    run.scene.fixtures[0].name = "pipe";
    run.scene.fixtures[0].box = Box{{0.0, 0.0, 0.0}, {0.2, 0.2, 0.2}};
    HostFixtures set = flatWall();
    set.frame = 0;
    for (int i = 0; i < 19; ++i) {
        addRegion(set, {0.1, 0.1, 0.1}, 0.04, 0);
    }
    const auto alarms = [&](double x) {
        addRegion(set, {x, 0.1, 0.1}, 0.04, 0);
        run.sink.frame({}, set);
        run.view.refresh();
        return run.step();
    };
    CHECK(alarms(0.199).empty()); // one of twenty
    CHECK(alarms(0.001).empty()); // two of twenty-one
    CHECK(alarms(0.001) == std::vector<std::string>{"ADVISORY active box pipe"});
}
