// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/behind.h"

#include "engine/contact/contact_fill.h"
#include "engine/contact/cull_cpu.h"
#include "tests/contact/images.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

HostFixtures wallAt(double z, uint64_t generation) {
    return wallImage(z, generation, 0.04);
}

// Answers queries at positions of a tool of one leaf.
struct Watch {
    Tool tool = ballTool(0.01);
    BehindTracker tracker;
    CullCpu cull;
    ContactSet set;

    const std::vector<ContactSet::Behind>& operator()(const HostFixtures& fixtures, const dvec3& position) {
        RegionGrid grid;
        grid.build(fixtures.spheres);
        cull.query(tool, {position, kUpright}, 0.01, fixtures, grid, set);
        tracker.update(tool, fixtures, grid.maxRadius(), set);
        return set.behind;
    }
};

} // namespace

TEST_CASE("A leaf that new data puts behind its surface is flagged, with the direction out") {
    Watch watch;
    CHECK(watch(wallAt(0.6, 1), dvec3(0, 0, 0.5)).empty());
    const auto& flags = watch(wallAt(0.47, 2), dvec3(0, 0, 0.5));
    REQUIRE(flags.size() == 1);
    CHECK(flags[0].leaf == 0);
    CHECK(glm::distance(flags[0].towardsCamera, dvec3(0, 0, -1)) < 1e-9);
    CHECK(flags[0].distance == doctest::Approx(0.03 + 0.05).epsilon(1e-6));
}

TEST_CASE("The flag stays while the leaf is under or near the surface and is cleared once the leaf is clear "
          "in front") {
    Watch watch;
    watch(wallAt(0.6, 1), dvec3(0, 0, 0.5));
    const HostFixtures near = wallAt(0.47, 2);
    CHECK(watch(near, dvec3(0, 0, 0.5)).size() == 1);
    CHECK(watch(near, dvec3(0, 0, 0.48)).size() == 1);
    CHECK(watch(wallAt(0.47, 3), dvec3(0, 0, 0.48)).size() == 1); // the next frame shows the same
    CHECK(watch(near, dvec3(0, 0, 0.43)).size() == 1);
    CHECK(watch(near, dvec3(0, 0, 0.4199)).empty());
    CHECK(watch(near, dvec3(0, 0, 0.43)).empty()); // back at the surface: in contact, not behind
}

TEST_CASE("A flagged leaf that overlaps a sphere before its surface keeps the flag until it is out of that") {
    Watch watch;
    watch(wallAt(0.6, 1), dvec3(0, 0, 0.5));
    HostFixtures near = wallAt(0.47, 2);
    near.spheres.add({0, 0, 0.45}, 0.04); // noise: 20 mm before the depth of its pixel
    REQUIRE(watch(near, dvec3(0, 0, 0.5)).size() == 1);
    const auto& flags = watch(near, dvec3(0, 0, 0.4199));
    REQUIRE(flags.size() == 1);
    CHECK(flags[0].distance == doctest::Approx(0.05 - 0.0301).epsilon(1e-6));
    CHECK(watch(near, dvec3(0, 0, 0.3999)).empty());
}

TEST_CASE("The way out of a surface that comes nearer grows by as much") {
    Watch watch;
    watch(wallAt(0.6, 1), dvec3(0, 0, 0.5));
    REQUIRE(watch(wallAt(0.47, 2), dvec3(0, 0, 0.5)).size() == 1);
    const auto& flags = watch(wallAt(0.45, 3), dvec3(0, 0, 0.5));
    REQUIRE(flags.size() == 1);
    CHECK(flags[0].distance == doctest::Approx(0.05 + 0.05).epsilon(1e-6));
}

TEST_CASE("The pixel nearest to a leaf decides whether it is behind, not the one before it") {
    for (const bool wallHere : {false, true}) {
        Watch watch;
        const dvec3 leaf(1.1 / 140.0 * 0.5, 0, 0.5); // at column 80.6
        watch(wallAt(0.6, 1), leaf);
        HostFixtures next = wallAt(0.47, 2);
        for (uint32_t v = 0; v < 120; ++v) {
            next.depth[v * 160 + (wallHere ? 80 : 81)] = 8000; // 0.8 m
        }
        CHECK(watch(next, leaf).size() == (wallHere ? 1 : 0));
    }
}

TEST_CASE("A leaf that moves behind a surface of the same set is occluded, not behind") {
    Watch watch;
    const HostFixtures wall = wallAt(0.5, 1);
    CHECK(watch(wall, dvec3(0, 0, 0.4)).empty());
    CHECK(watch(wall, dvec3(0, 0, 0.6)).empty());
    CHECK(watch(wallAt(0.5, 2), dvec3(0, 0, 0.6)).empty());
}

TEST_CASE("No leaf is flagged at the first set, behind allowed points, without depth or outside the image") {
    Watch watch;
    CHECK(watch(wallAt(0.4, 1), dvec3(0, 0, 0.5)).empty());
    for (const int what : {0, 1, 2, 3}) {
        Watch other;
        other(wallAt(0.6, 1), what == 3 ? dvec3(5, 0, 0.5) : dvec3(0, 0, 0.5));
        HostFixtures next = wallAt(0.4, 2);
        if (what == 0) {
            std::fill(next.forbiddenBits.begin(), next.forbiddenBits.end(), 0u);
        } else if (what == 1) {
            std::fill(next.depth.begin(), next.depth.end(), uint16_t{0});
        } else if (what == 2) {
            next.depth.clear();
        }
        CHECK(other(next, what == 3 ? dvec3(5, 0, 0.5) : dvec3(0, 0, 0.5)).empty());
    }
}

TEST_CASE(
    "A leaf that was in front of allowed points and is now hidden by a region is occluded, not behind") {
    Watch watch;
    HostFixtures open = wallAt(0.6, 1);
    std::fill(open.forbiddenBits.begin(), open.forbiddenBits.end(), 0u);
    watch(open, dvec3(0, 0, 0.5));
    CHECK(watch(wallAt(0.4, 2), dvec3(0, 0, 0.5)).empty());
}

TEST_CASE("A flagged leaf keeps its flag while its pixel has no depth and loses it in a free view") {
    Watch watch;
    watch(wallAt(0.6, 1), dvec3(0, 0, 0.5));
    REQUIRE(watch(wallAt(0.47, 2), dvec3(0, 0, 0.5)).size() == 1);
    HostFixtures blind = wallAt(0.47, 3);
    std::fill(blind.depth.begin(), blind.depth.end(), uint16_t{0});
    CHECK(watch(blind, dvec3(0, 0, 0.5)).size() == 1);
    HostFixtures open = wallAt(0.8, 4);
    std::fill(open.forbiddenBits.begin(), open.forbiddenBits.end(), 0u);
    CHECK(watch(open, dvec3(0, 0, 0.5)).empty());
}

TEST_CASE("Depth noise does not flag a small tool that rests on a small region") {
    Watch watch;
    watch.tool = ballTool(0.001);
    uint64_t generation = 0;
    for (const double z : {0.505, 0.503, 0.5065, 0.5035, 0.505}) {
        CHECK(watch(wallImage(z, ++generation, 0.001), dvec3(0, 0, 0.503)).empty());
    }
}

TEST_CASE("Something that appears farther in front of a leaf than R + r and the reach only hides it") {
    for (const double z : {0.45, 0.441, 0.439, 0.25}) {
        Watch watch;
        watch(wallAt(0.6, 1), dvec3(0, 0, 0.5));
        CHECK(watch(wallAt(z, 2), dvec3(0, 0, 0.5)).size() == (z > 0.44 ? 1 : 0));
    }
}

TEST_CASE("What is far in front of a leaf flags it neither where a region is beside the leaf") {
    Watch watch;
    watch(wallAt(0.6, 1), dvec3(0, 0, 0.5));
    HostFixtures fish = wallAt(0.6, 2);
    fish.spheres.add({0.045, 0, 0.49}, 0.03);
    std::fill(fish.depth.begin(), fish.depth.end(), uint16_t{2500});
    CHECK(watch(fish, dvec3(0, 0, 0.5)).empty());
    CHECK(watch.set.size() == 1);
}

TEST_CASE("A pixel whose point was rejected, as of marine snow, flags no leaf") {
    for (const double wall : {0.6, 0.555}) { // out of reach, and in it
        Watch watch;
        watch(wallAt(wall, 1), dvec3(0, 0, 0.5));
        HostFixtures snow = wallAt(wall, 2);
        snow.depth[60 * 160 + 80] = 4700;
        CHECK(watch(snow, dvec3(0, 0, 0.5)).empty());
    }
}

TEST_CASE("What passes far in front of a flagged leaf does not lengthen its way out") {
    Watch watch;
    watch(wallAt(0.6, 1), dvec3(0, 0, 0.5));
    REQUIRE(watch(wallAt(0.47, 2), dvec3(0, 0, 0.5)).size() == 1);
    HostFixtures fish = wallAt(0.47, 3);
    std::fill(fish.depth.begin(), fish.depth.end(), uint16_t{2500});
    const auto& flags = watch(fish, dvec3(0, 0, 0.5));
    REQUIRE(flags.size() == 1);
    CHECK(flags[0].distance == doctest::Approx(0.03 + 0.05).epsilon(1e-6));
}
