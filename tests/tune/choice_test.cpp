// SPDX-License-Identifier: Apache-2.0
// The choice among points of error against time, on made-up points.
#include "apps/tune/tune_choice.h"

#include <doctest/doctest.h>
#include <limits>

using namespace fathom::tune;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Request errorAtMost(double mm) {
    return {mm, {}};
}
Request timeAtMost(double ms) {
    return {{}, ms};
}

} // namespace

TEST_CASE("No point is chosen from an empty list, and none is nearest") {
    for (const Request& request : {errorAtMost(1.0), timeAtMost(1.0)}) {
        const Choice choice = choose({}, request);
        CHECK(!choice.point);
        CHECK(!choice.nearest);
    }
    CHECK(frontOf({}).empty());
}

TEST_CASE("A single point is chosen when it meets the request, its limit included, and is nearest when not") {
    const std::vector<Score> one{{0.5, 2.0, 0.1}};
    CHECK(choose(one, errorAtMost(0.5)).point == 0u);
    CHECK(choose(one, timeAtMost(2.0)).point == 0u);
    CHECK(!choose(one, errorAtMost(0.49)).point);
    CHECK(choose(one, errorAtMost(0.49)).nearest == 0u);
    CHECK(!choose(one, timeAtMost(1.99)).point);
    CHECK(frontOf(one) == std::vector<bool>{true});
}

TEST_CASE("A largest error asks for the fastest point, a longest time for the least error") {
    const std::vector<Score> points{{0.1, 9.0, 0.1}, {0.3, 4.0, 0.1}, {0.8, 1.0, 0.1}};
    CHECK(choose(points, errorAtMost(0.5)).point == 1u);
    CHECK(choose(points, errorAtMost(0.1)).point == 0u);
    CHECK(choose(points, errorAtMost(2.0)).point == 2u);
    CHECK(choose(points, timeAtMost(5.0)).point == 1u);
    CHECK(choose(points, timeAtMost(50.0)).point == 0u);
    CHECK(choose(points, timeAtMost(1.0)).point == 2u);
}

TEST_CASE("Times that differ as little as repeats do are decided by the ripple, and equal ripples by order") {
    CHECK(choose({{0.2, 1.00, 0.20}, {0.2, 1.08, 0.05}}, errorAtMost(1.0)).point == 1u);
    CHECK(choose({{0.2, 1.00, 0.20}, {0.2, 1.12, 0.05}}, errorAtMost(1.0)).point == 0u);
    CHECK(choose({{0.20, 3.0, 0.20}, {0.21, 3.0, 0.05}}, timeAtMost(5.0)).point == 1u);
    CHECK(choose({{0.2, 1.05, 0.105}, {0.2, 1.00, 0.100}}, errorAtMost(1.0)).point == 0u);
    CHECK(choose({{0.2, 1.0, 0.0}, {0.2, 1.0, 0.0}}, errorAtMost(1.0)).point == 0u); // ties
}

TEST_CASE("Dominated points are off the front and name the fastest point that beats them; equal ones stay") {
    const std::vector<Score> points{{0.5, 5.0, 0.1}, {0.4, 4.0, 0.1}, {0.3, 4.5, 0.1}, {0.4, 4.0, 0.9}};
    CHECK(frontOf(points) == std::vector<bool>{false, true, true, true});
    CHECK(dominatorOf(points, 0) == 1u);
    CHECK(!dominatorOf(points, 1));
    CHECK(!dominatorOf(points, 3));
}

TEST_CASE("When none meets the request, the point that misses it by the smallest factor is nearest") {
    const std::vector<Score> points{{0.9, 1.0, 0.1}, {0.4, 9.0, 0.1}, {0.6, 3.0, 0.1}};
    CHECK(!choose(points, errorAtMost(0.2)).point);
    CHECK(choose(points, errorAtMost(0.2)).nearest == 1u);
    CHECK(choose(points, timeAtMost(0.5)).nearest == 0u);
    CHECK(choose(points, timeAtMost(0.5)).nearestOpen);
}

TEST_CASE("A point that cannot be chosen never is, and is nearest only when no other point is left") {
    const Score closed{0.1, 0.1, 0.0, "the camera has no such size"};
    const Choice choice = choose({closed, {0.5, 5.0, 0.1}}, errorAtMost(1.0));
    CHECK(choice.point == 1u);
    CHECK(choose({closed, {0.5, 5.0, 0.1}}, errorAtMost(0.2)).nearest == 1u);
    CHECK(choose({closed}, errorAtMost(1.0)).nearest == 0u);
    CHECK(!choose({closed}, errorAtMost(1.0)).nearestOpen);
    CHECK(!meets(closed, errorAtMost(1.0)));
}

TEST_CASE("Points without an error, a ripple or a time are neither chosen, nor nearest, nor on the front") {
    const std::vector<Score> points{{kNone, 1.0, 0.1}, {0.1, 0.0, 0.1}, {0.1, 1.0, kNone}, {0.2, 2.0, 0.1}};
    CHECK(choose(points, errorAtMost(1.0)).point == 3u);
    CHECK(choose(points, errorAtMost(0.05)).nearest == 3u);
    CHECK(frontOf(points) == std::vector<bool>{false, false, false, true});
}
