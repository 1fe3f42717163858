// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/region_grid.h"

#include "engine/types/thread_pool.h"
#include "tests/contact/clouds.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Every sphere whose centre is within distance must be visited, and none twice. Returns their number.
size_t checkAgainstBruteForce(const RegionSpheres& spheres, const RegionGrid& grid, const dvec3& point,
                              double distance) {
    std::vector<int> visits(spheres.size(), 0);
    grid.forEachNear(point, distance, [&](uint32_t i) { ++visits[i]; });
    size_t missed = 0, twice = 0, visited = 0;
    for (size_t i = 0; i < spheres.size(); ++i) {
        const double d = glm::distance(point, dvec3(spheres.x[i], spheres.y[i], spheres.z[i]));
        missed += d <= distance && visits[i] == 0 ? 1 : 0;
        twice += visits[i] > 1 ? 1 : 0;
        visited += visits[i] != 0 ? 1 : 0;
    }
    CHECK(missed == 0);
    CHECK(twice == 0);
    return visited;
}

} // namespace

TEST_CASE("An empty grid visits nothing") {
    RegionGrid grid;
    grid.build(RegionSpheres{});
    CHECK(grid.size() == 0);
    CHECK(grid.maxRadius() == 0.0);
    grid.forEachNear(dvec3(0.0), 1e9, [](uint32_t) { FAIL("visited"); });
}

TEST_CASE("The grid finds a single sphere, and all of several equal ones") {
    for (const size_t count : {size_t{1}, size_t{1000}}) {
        HostFixtures set = emptySet();
        for (size_t i = 0; i < count; ++i) {
            set.spheres.add(dvec3(0.5, -0.25, 2.0), 0.04);
        }
        RegionGrid grid;
        grid.build(set.spheres);
        CHECK(checkAgainstBruteForce(set.spheres, grid, dvec3(0.5, -0.25, 2.0), 0.0) == count);
        CHECK(checkAgainstBruteForce(set.spheres, grid, dvec3(0.5, -0.25, 2.1), 0.11) == count);
        CHECK(checkAgainstBruteForce(set.spheres, grid, dvec3(0.5, -0.25, 9.0), 0.1) == 0);
    }
}

TEST_CASE("The grid misses no sphere of random clouds of any radii and extent") {
    std::mt19937_64 random(7);
    const double halves[] = {0.001, 0.3, 5.0, 20000.0};
    for (const double half : halves) {
        const HostFixtures set = randomCloud(random, 3001, half, 1e-4, 10.0);
        RegionGrid grid;
        grid.build(set.spheres);
        CHECK(grid.size() == set.spheres.size());
        for (int k = 0; k < 60; ++k) {
            const dvec3 point = randomIn(random, half * 1.3);
            for (const double distance : {0.0, half * 0.01, half * 0.2, half * 3.0}) {
                checkAgainstBruteForce(set.spheres, grid, point, distance);
            }
            const size_t own = static_cast<size_t>(k);
            const dvec3 at(set.spheres.x[own], set.spheres.y[own], set.spheres.z[own]);
            CHECK(checkAgainstBruteForce(set.spheres, grid, at, 0.0) >= 1);
        }
    }
}

TEST_CASE("One far outlier costs no memory and no result") {
    std::mt19937_64 random(8);
    HostFixtures set = randomCloud(random, 2000, 0.5, 0.01, 0.04);
    set.spheres.add(dvec3(1e6, -2e6, 3e7), 0.04);
    RegionGrid grid;
    grid.build(set.spheres);
    CHECK(checkAgainstBruteForce(set.spheres, grid, dvec3(1e6, -2e6, 3e7), 10.0) == 1);
    checkAgainstBruteForce(set.spheres, grid, dvec3(0.1, 0.2, 0.3), 0.2);
}

TEST_CASE("Spheres that are not finite are skipped and the others are found") {
    HostFixtures set = emptySet();
    set.spheres.add(dvec3(0.0), 0.04);
    set.spheres.add(dvec3(std::numeric_limits<double>::quiet_NaN()), 0.04);
    set.spheres.add(dvec3(std::numeric_limits<double>::infinity()), 0.04);
    set.spheres.add(dvec3(0.1), 0.04);
    RegionGrid grid;
    grid.build(set.spheres);
    CHECK(grid.size() == 2);
    std::vector<uint32_t> seen;
    grid.forEachNear(dvec3(0.05), 1.0, [&](uint32_t i) { seen.push_back(i); });
    std::sort(seen.begin(), seen.end());
    CHECK(seen == std::vector<uint32_t>{0, 3});
}

// The second time, one in the middle is not finite.
void checkSharedGrid(size_t count, double leastRadius, ThreadPool& workers) {
    HostFixtures set = emptySet();
    for (size_t i = 0; i < count; ++i) {
        const double at = static_cast<double>(i * 7919 % 50'021) / 50'021.0;
        set.spheres.add(dvec3(at, std::fmod(at * 37.0, 0.6), std::fmod(at * 411.0, 0.3)),
                        leastRadius * (1.0 + 2.0 * at));
    }
    for (const bool broken : {false, true}) {
        set.spheres.y[count / 2] = broken ? std::numeric_limits<float>::quiet_NaN() : 0.1f;
        RegionGrid alone, shared;
        alone.build(set.spheres);
        shared.build(set.spheres, &workers);
        CHECK(alone.size() == count - (broken ? 1 : 0));
        CHECK(alone.maxRadius() == shared.maxRadius());
        CHECK(std::ranges::equal(alone.order(), shared.order()));
        CHECK(std::ranges::equal(alone.x(), shared.x()));
        CHECK(std::ranges::equal(alone.y(), shared.y()));
        CHECK(std::ranges::equal(alone.z(), shared.z()));
        CHECK(std::ranges::equal(alone.radius(), shared.radius()));
        checkAgainstBruteForce(set.spheres, shared, dvec3(0.4, 0.3, 0.1), 0.05);
    }
}

TEST_CASE("A grid does not depend on the number of threads, also with spheres that are not finite") {
    ThreadPool workers(3);
    for (const size_t count : {size_t{1}, size_t{4097}, size_t{50'000}}) {
        for (const double radius : {0.01, 0.1}) { // more cells than spheres, and fewer
            CAPTURE(count);
            CAPTURE(radius);
            checkSharedGrid(count, radius, workers);
        }
    }
}

TEST_CASE("Building again discards the earlier contents") {
    std::mt19937_64 random(9);
    RegionGrid grid;
    grid.build(randomCloud(random, 500, 1.0, 0.01, 0.04).spheres);
    const HostFixtures set = randomCloud(random, 77, 0.2, 0.01, 0.02);
    grid.build(set.spheres);
    CHECK(checkAgainstBruteForce(set.spheres, grid, dvec3(0.0), 10.0) == 77);
}
