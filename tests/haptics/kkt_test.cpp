// SPDX-License-Identifier: Apache-2.0
// Tests of the checkers: a correct solution passes, each kind of error raises its own figure, and the
// reference solves cases known by hand.
#include "engine/reference/kkt.h"
#include "engine/reference/nearest_point.h"
#include "engine/types/error.h"
#include "tests/haptics/constraint_sets.h"

#include <doctest/doctest.h>

#include <array>

using namespace fathom;

namespace {

// Corner x >= 1, y >= 2 with metric diag(1, 4) and target (0, 0): x = (1, 2), lambda = (1, 8).
const std::array<double, 4> kMetric{1, 0, 0, 4};
const std::array<double, 2> kTarget{0, 0};
const std::array<double, 6> kNormals{1, 0, 0, 1, -1, -1};
const std::array<double, 3> kOffsets{1, 2, -10};
const NearestPointProblem kCorner{2, kMetric, kTarget, kNormals, kOffsets};

} // namespace

TEST_CASE("The KKT check passes a correct solution and reports the kind of error of a wrong one") {
    CHECK(checkKkt(kCorner, std::array<double, 2>{1, 2}, std::array<double, 3>{1, 8, 0}).worst() <= 1e-17);
    const auto inside = checkKkt(kCorner, std::array<double, 2>{0.9, 2}, std::array<double, 3>{0.9, 8, 0});
    CHECK(inside.primal > 0.01);
    const auto pulling = checkKkt(kCorner, std::array<double, 2>{1, 2}, std::array<double, 3>{1, 8, -0.5});
    CHECK(pulling.dual > 0.01);
    const auto unbalanced = checkKkt(kCorner, std::array<double, 2>{1, 2}, std::array<double, 3>{1, 7, 0});
    CHECK(unbalanced.stationarity > 0.01);
    CHECK(unbalanced.primal <= 1e-17);
    // Feasible and balanced, but with a multiplier on an inactive row: not the nearest point.
    const auto slack = checkKkt(kCorner, std::array<double, 2>{1.5, 2}, std::array<double, 3>{1.5, 8, 0});
    CHECK(slack.stationarity <= 1e-17);
    CHECK(slack.primal == 0.0);
    CHECK(slack.complementarity > 0.01);
    const std::array<double, 4> bad{1, 2, 2, 1};
    CHECK_THROWS_AS(checkKkt({2, bad, kTarget, kNormals, kOffsets}, kTarget, std::array<double, 3>{}), Error);
}

TEST_CASE("The reference finds the corner, keeps a free target and detects overlapping walls") {
    const auto corner = nearestPoint(kCorner);
    REQUIRE(corner.feasible);
    CHECK(corner.x[0] == doctest::Approx(1.0).epsilon(1e-15));
    CHECK(corner.x[1] == doctest::Approx(2.0).epsilon(1e-15));
    CHECK(corner.multipliers[1] == doctest::Approx(8.0).epsilon(1e-15));
    const std::array<double, 2> free{3, 3};
    const auto untouched = nearestPoint({2, kMetric, free, kNormals, kOffsets});
    CHECK(untouched.x == std::vector<double>{3, 3});
    CHECK(nearestPoint({2, kMetric, free, {}, {}}).x == std::vector<double>{3, 3});
    const std::array<double, 3> tight{1, 2, -2.9}; // x + y <= 2.9 against x >= 1, y >= 2
    CHECK_FALSE(nearestPoint({2, kMetric, kTarget, kNormals, tight}).feasible);
    const std::array<double, 3> touching{1, 2, -3};
    CHECK(nearestPoint({2, kMetric, kTarget, kNormals, touching}).feasible);
    const std::array<double, 2> zero{0, 0};
    CHECK_FALSE(nearestPoint({2, kMetric, kTarget, zero, std::array<double, 1>{0.1}}).feasible);
}

TEST_CASE("Every solution of the reference on random sets satisfies the KKT conditions") {
    Rng random(12);
    int feasible = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto kind = static_cast<RowFamily>(i % kRowFamilies);
        const auto set = makeSet(kind, i % 3 == 0 ? 8 : 6, 1 + random.below(80), 0.05, random);
        const auto answer = nearestPoint(set.problem());
        if (answer.feasible) {
            ++feasible;
            CHECK(checkKkt(set.problem(), answer.x, answer.multipliers).worst() <= 1e-9);
        }
    }
    CHECK(feasible > 500);
}
