// SPDX-License-Identifier: Apache-2.0
// Distance to the nearest region, looks by distance, the tool's shadow, sides of the 3D view.
#include "apps/operate/depth_cues.h"
#include "apps/operate/space_marks.h"
#include "apps/output/silhouette.h"
#include "tests/apps/flat_wall.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE("The nearest pair of tool and regions is the one that a search over all pairs finds") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> at(-0.4, 0.4), size(0.005, 0.04);
    HostFixtures set;
    set.origin = {0.1, 0.0, 1.0};
    for (int i = 0; i < 400; ++i) {
        addRegion(set, {at(random), at(random), at(random)}, size(random), static_cast<uint8_t>(i % 3));
    }
    for (int tries = 0; tries < 20; ++tries) {
        std::vector<Sphere> tool;
        const dvec3 shift(2.0 * at(random), 2.0 * at(random), 1.0 + at(random));
        for (int i = 0; i < 21; ++i) {
            tool.push_back({shift + 0.3 * dvec3(at(random), at(random), at(random)), size(random)});
        }
        double least = std::numeric_limits<double>::infinity();
        for (size_t i = 0; i < set.spheres.size(); ++i) {
            for (const Sphere& s : tool) {
                least = std::min(least, glm::distance(s.centre, regionCentre(set, i)) - s.radius -
                                            double{set.spheres.radius[i]});
            }
        }
        const auto nearest = nearestRegion(set, tool);
        REQUIRE(nearest);
        CHECK(nearest->gap == doctest::Approx(least));
        if (least > 0.0) {
            CHECK(glm::distance(nearest->from, nearest->to) == doctest::Approx(least));
        }
    }
    CHECK(!nearestRegion(set, {}));
    CHECK(!nearestRegion(HostFixtures(), std::vector<Sphere>{{dvec3(0.0), 0.01}}));
}

TEST_CASE(
    "Distances are white and thin, amber from 50 mm, red and thick from 10 mm, and rounded for a pilot") {
    CHECK(lookOf(0.051) == GapLook::Far);
    CHECK(lookOf(0.049) == GapLook::Near);
    CHECK(lookOf(0.0101) == GapLook::Near);
    CHECK(lookOf(0.0099) == GapLook::Close);
    CHECK(lookOf(-0.001) == GapLook::Close);
    CHECK(gapText(0.00421) == "4.2 mm");
    CHECK(gapText(-0.002) == "0.0 mm");
    CHECK(gapText(0.0384) == "38 mm");
    CHECK(gapText(1.236) == "1.24 m");
    CHECK(gapText(std::numeric_limits<double>::infinity()) == "no region");
    CHECK(gapText(std::numeric_limits<double>::quiet_NaN()) == "unknown");
}

TEST_CASE("The shadow is on the surface behind the tool, below and right of it, and a hidden tool has none") {
    const HostFixtures set = flatWall();
    const std::vector<Sphere> tool{{{0.0, 0.0, 0.8}, 0.02}};
    const auto shadow = shadowOf(set, tool);
    REQUIRE(shadow.size() == 1);
    CHECK(shadow[0].centre.z == doctest::Approx(1.0).epsilon(0.01));
    CHECK(shadow[0].centre.x == doctest::Approx(0.07).epsilon(0.1)); // 0.2 m farther along the light
    CHECK(shadow[0].centre.y == doctest::Approx(0.10).epsilon(0.1));
    CHECK(shadow[0].radius == 0.02);
    CHECK(shadowOf(set, std::vector<Sphere>{{{0.0, 0.0, 1.2}, 0.02}}).empty());
    HostFixtures blind = flatWall();
    blind.depth.assign(blind.depth.size(), 0);
    CHECK(shadowOf(blind, tool).empty());
}

TEST_CASE("The gap is the measured clearance, or without one the distance of the nearest pair") {
    HostFixtures set = flatWall();
    addRegion(set, {0.0, 0.0, 1.0}, 0.05, 0);
    const std::vector<Sphere> tool{{{0.0, 0.0, 0.9}, 0.02}};
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    CHECK(depthCues(set, tool, 0.031).gap == 0.031);
    CHECK(depthCues(set, tool, unknown).gap == doctest::Approx(0.03));
    CHECK(std::isinf(depthCues(flatWall(), tool, unknown).gap));
    CHECK(std::isnan(depthCues(set, {}, unknown).gap));
}

TEST_CASE("The 3D view looks along z from the front, along x from the side, along y from the top") {
    Orbit orbit;
    orbit.distance = 2.0;
    const auto forward = [&](Side side) {
        lookFrom(orbit, side);
        return orbit.pose().rotation * dvec3(0, 0, 1);
    };
    CHECK(glm::distance(forward(Side::Front), dvec3(0, 0, 1)) < 1e-9);
    CHECK(std::abs(forward(Side::Right).x) > 1.0 - 1e-9);
    CHECK(glm::distance(forward(Side::Top), dvec3(0, 1, 0)) < 1e-9); // y points down
    CHECK(orbit.distance == 2.0);
    lookFrom(orbit, Side::Reset);
    CHECK(orbit.yaw == Orbit().yaw);
    CHECK(orbit.distance == Orbit().distance);
}
