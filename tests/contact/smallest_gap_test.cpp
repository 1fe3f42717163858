// SPDX-License-Identifier: Apache-2.0
// The smallest gap of a tool, on the host, against brute force over all pairs.
#include "engine/contact/smallest_gap.h"
#include "engine/reference/contact_oracle.h"
#include "tests/contact/clouds.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

void check(GapSearch& search, const Tool& tool, const Pose& pose, const HostFixtures& set) {
    const SmallestGap found = search.find(tool, pose), truth = oracleSmallestPair(tool, pose, set);
    CHECK(found == truth);
    CHECK(found.gap == doctest::Approx(oracleSmallestGap(tool, pose, set)).epsilon(1e-12));
}

} // namespace

TEST_CASE("The host's smallest gap and its pair are those of brute force, near, far and inside of a set") {
    std::mt19937_64 random(41);
    GapSearch search;
    for (const size_t count : {size_t{1}, size_t{255}, size_t{256}, size_t{257}, size_t{3001}}) {
        HostFixtures set = randomCloud(random, count, 0.3, 0.002, 0.05);
        set.origin = dvec3(120.0, -3.0, 7.0);
        search.build(set);
        const Tool tool = randomTool(random, 37, 0.1, 0.01);
        for (const double away : {0.0, 0.5, 3.0, 2000.0}) {
            check(search, tool, {set.origin + randomIn(random, 0.1 + away), randomRotation(random)}, set);
        }
    }
}

TEST_CASE("Of equal gaps the host takes the lowest source, then the lowest leaf") {
    HostFixtures set = emptySet();
    for (const double x : {0.2, -0.2, 0.2}) {
        set.spheres.add({x, 0.0, 0.0}, 0.05);
    }
    set.spheres.source = {9, 4, 7};
    const Tool tool = makeTool({{{0.0, 0.0, 0.0}, 0.01}, {{0.0, 0.0, 0.0}, 0.01}});
    GapSearch search;
    search.build(set);
    const SmallestGap found = search.find(tool, Pose{});
    CHECK(found.source == 4);
    CHECK(found.leaf == 0);
    CHECK(found == oracleSmallestPair(tool, Pose{}, set));
}

TEST_CASE("Without spheres the smallest gap is infinite, and for a broken pose it is unknown") {
    const HostFixtures none = emptySet();
    GapSearch search;
    search.build(none);
    CHECK(search.find(ballTool(0.01), Pose{}).gap == std::numeric_limits<double>::infinity());
    CHECK_FALSE(search.find(ballTool(0.01), Pose{}).any());
    HostFixtures one = emptySet();
    one.spheres.add(dvec3(0.0), 0.1);
    search.build(one);
    const Pose broken{{std::nan(""), 0.0, 0.0}, kUpright};
    CHECK(std::isnan(search.find(ballTool(0.01), broken).gap));
    CHECK_FALSE(search.find(ballTool(0.01), broken).any());
}
