// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/leaf_centres.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace fathom;

namespace {

LeafCentres scattered(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> at(-1.0, 1.0);
    LeafCentres centres(count);
    for (size_t i = 0; i < count; ++i) {
        centres.set(i, dvec3(at(random), at(random), at(random)));
    }
    return centres;
}

} // namespace

TEST_CASE("Displacements, their maximum and the limit test are exact for any number of leaves") {
    for (const size_t count : {1, 2, 7, 8, 9, 15, 16, 17, 100, 479}) {
        CAPTURE(count);
        const LeafCentres from = scattered(count, 1), to = scattered(count, 2);
        std::vector<double> ways(count), own(count);
        leafDisplacements(from, to, ways);
        for (size_t i = 0; i < count; ++i) {
            own[i] = glm::distance(from[i], to[i]);
        }
        CHECK(ways == own); // bit by bit
        const double most = *std::max_element(own.begin(), own.end());
        CHECK(leafDisplacement(from, to) == most);
        CHECK(leavesWithin(from, to, most * (1.0 + 1e-15)));
        CHECK(!leavesWithin(from, to, most * (1.0 - 1e-15)));
        CHECK(!leavesWithin(from, to, -most));
    }
}

TEST_CASE("Without leaves the largest displacement is 0 and every limit holds") {
    const LeafCentres none;
    CHECK(leafDisplacement(none, none) == 0.0);
    CHECK(leavesWithin(none, none, -1.0));
}

TEST_CASE("A NaN displacement is within no limit and is never the largest") {
    const size_t count = 19;
    for (size_t bad = 0; bad < count; ++bad) {
        CAPTURE(bad);
        const LeafCentres from = scattered(count, 3);
        LeafCentres to = scattered(count, 4);
        to.z[bad] = std::numeric_limits<double>::quiet_NaN();
        std::vector<double> ways(count);
        leafDisplacements(from, to, ways);
        CHECK(std::isnan(ways[bad]));
        ways.erase(ways.begin() + static_cast<std::ptrdiff_t>(bad));
        CHECK(leafDisplacement(from, to) == *std::max_element(ways.begin(), ways.end()));
        CHECK(!leavesWithin(from, to, std::numeric_limits<double>::infinity()));
    }
}
