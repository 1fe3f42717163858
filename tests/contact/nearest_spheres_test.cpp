// SPDX-License-Identifier: Apache-2.0
// The nearest sphere of each leaf against brute force.
#include "engine/contact/nearest_spheres.h"
#include "tests/contact/clouds.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

float gapOf(const PosedLeaves& leaves, size_t leaf, const RegionSpheres& s, size_t sphere) {
    const float dx = leaves.x[leaf] - s.x[sphere], dy = leaves.y[leaf] - s.y[sphere],
                dz = leaves.z[leaf] - s.z[sphere];
    return std::sqrt(dx * dx + dy * dy + dz * dz) - (leaves.radius[leaf] + s.radius[sphere]);
}

// Smallest gap over all spheres; infinity when none is up to the limit.
float smallestGap(const PosedLeaves& leaves, size_t leaf, const RegionSpheres& s, float limit) {
    float least = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < s.size(); ++i) {
        const float gap = gapOf(leaves, leaf, s, i);
        least = gap <= limit ? std::min(least, gap) : least;
    }
    return least;
}

// Number of leaves that have one.
size_t check(const HostFixtures& fixtures, const Tool& tool, const Pose& pose, float limit) {
    RegionGrid grid;
    grid.build(fixtures.spheres);
    PosedLeaves leaves;
    poseLeaves(tool, pose, fixtures.origin, leaves);
    std::vector<NearestSphere> found;
    nearestSpheres(leaves, limit, grid, found);
    REQUIRE(found.size() == tool.leafCount());
    size_t near = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        const float least = smallestGap(leaves, i, fixtures.spheres, limit);
        CHECK(found[i].gap == least);
        CHECK((found[i].sphere == NearestSphere::kNone) == std::isinf(least));
        if (found[i].sphere != NearestSphere::kNone) {
            CHECK(gapOf(leaves, i, fixtures.spheres, found[i].sphere) == least);
            ++near;
        }
    }
    return near;
}

} // namespace

TEST_CASE("The nearest sphere of every leaf has the smallest gap in sets of any size") {
    std::mt19937_64 random(31);
    size_t near = 0;
    for (const size_t count : {size_t{1}, size_t{15}, size_t{16}, size_t{17}, size_t{333}, size_t{5000}}) {
        const HostFixtures fixtures = randomCloud(random, count, 0.3, 0.002, 0.05);
        const Tool tool = randomTool(random, 37, 0.1, 0.01);
        for (const float limit : {0.0f, 0.01f, 0.5f}) {
            for (int k = 0; k < 4; ++k) {
                near += check(fixtures, tool, {randomIn(random, 0.3), randomRotation(random)}, limit);
            }
        }
    }
    CHECK(near > 1000);
}

TEST_CASE("A leaf with no sphere within the limit has none, and an empty set has none for any leaf") {
    HostFixtures fixtures = emptySet();
    const Tool tool = ballTool(0.01);
    CHECK(check(fixtures, tool, {dvec3(0.0), kUpright}, 1.0f) == 0);
    fixtures.spheres.add(dvec3(0.0, 0.0, 0.05), 0.01);
    CHECK(check(fixtures, tool, {dvec3(0.0), kUpright}, 0.029f) == 0);
    CHECK(check(fixtures, tool, {dvec3(0.0), kUpright}, 0.031f) == 1);
}
