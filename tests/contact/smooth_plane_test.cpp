// SPDX-License-Identifier: Apache-2.0
// The plane over neighbouring spheres: outside of all of them, smooth where the spheres' union has cusps.
#include "engine/contact/smooth_plane.h"

#include "tests/contact/clouds.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kLeaf = 0.01, kBall = 0.04, kTouch = kLeaf + kBall; // [m]

struct Patch {
    RegionSpheres spheres;

    SphereSpan run() const {
        return {spheres.x.data(), spheres.y.data(), spheres.z.data(), spheres.radius.data(),
                spheres.x.size()};
    }
    // Of the spheres with a normal near `side` (zero: of all).
    SmoothPlane tangent(const dvec3& leaf, const dvec3& side = dvec3(0.0)) const {
        SmoothPlane least{side, HUGE_VAL};
        for (size_t k = 0; k < spheres.x.size(); ++k) {
            const double gap = gapOf(run(), k, {leaf, kLeaf});
            const dvec3 normal = glm::normalize(awayFrom(run(), k, leaf));
            if (gap < least.gap && (side == dvec3(0.0) || glm::dot(normal, side) > 0.8)) {
                least = {normal, gap};
            }
        }
        return least;
    }
    double nearest(const dvec3& leaf) const { return tangent(leaf).gap; }
    bool plane(const dvec3& leaf, SmoothPlane& out, const dvec3& side = dvec3(0.0)) const {
        SmoothPlane near = tangent(leaf, side);
        near.gap = std::max(0.0, near.gap);
        return smoothPlane(run(), {leaf, kLeaf}, near, patchDepth(kTouch), out);
    }
};

Patch wallOf(double spacing, double noise) {
    Patch patch;
    std::mt19937_64 random(5);
    std::normal_distribution<double> n(0.0, 1.0);
    for (int i = -20; i <= 20; ++i) {
        for (int j = -20; j <= 20; ++j) {
            patch.spheres.add({spacing * i, spacing * j, -kBall + noise * n(random)}, kBall);
        }
    }
    return patch;
}

} // namespace

TEST_CASE(
    "Over a lattice of spheres the plane is flat to 0.002 of slope, where the spheres' own slope is 0.04") {
    for (const double spacing : {0.001, 0.002, 0.0042}) {
        Patch wall = wallOf(spacing, 0.0);
        double steepest = 0.0, own = 0.0;
        for (double x = spacing / 74.0; x < spacing; x += spacing / 37.0) {
            const dvec3 leaf(x, 0.3 * x, kLeaf + 2e-4);
            SmoothPlane plane;
            REQUIRE(wall.plane(leaf, plane));
            steepest = std::max(steepest, std::hypot(plane.normal.x, plane.normal.y));
            own = std::max(own, std::abs(std::remainder(x, spacing)) / kTouch);
            CHECK(plane.gap == doctest::Approx(2e-4).epsilon(0.02));
        }
        CAPTURE(spacing);
        CHECK(steepest < 0.002);
        CHECK(own > 0.45 * spacing / kTouch);
    }
}

TEST_CASE("A leaf that moves along the plane, by as much as its gap, enters no sphere of the patch") {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> u(-0.01, 0.01);
    Patch wall = wallOf(0.002, 2e-4);
    for (int trial = 0; trial < 200; ++trial) {
        dvec3 leaf(u(random), u(random), kLeaf + 0.002);
        leaf.z -= wall.nearest(leaf) - 1e-4; // nearly in touch
        leaf.z += std::max(0.0, 1e-5 - wall.nearest(leaf));
        SmoothPlane plane;
        if (!wall.plane(leaf, plane)) {
            continue;
        }
        CHECK(plane.gap <= wall.nearest(leaf));
        CHECK(plane.gap >= wall.nearest(leaf) - patchDepth(kTouch));
        const dvec3 onto = leaf - std::max(0.0, plane.gap) * plane.normal;
        CHECK(wall.nearest(onto) >= (plane.gap > 0.0 ? -1e-9 : -1.0));
    }
}

TEST_CASE("A raised sphere that the patch reaches lowers the plane's gap without a step") {
    Patch wall = wallOf(0.002, 0.0);
    wall.spheres.add({0.001, 0.001, -kBall + 1e-4}, kBall);
    double before = HUGE_VAL, most = 0.0, lowest = HUGE_VAL;
    for (double x = 0.012; x > 0.005; x -= 1e-5) {
        SmoothPlane plane;
        REQUIRE(wall.plane({x, 0.001, kLeaf + 2e-4}, plane));
        most = before == HUGE_VAL ? 0.0 : std::max(most, std::abs(plane.gap - before));
        before = plane.gap;
        lowest = std::min(lowest, plane.gap);
    }
    CHECK(lowest < 1.3e-4);
    CHECK(most < 2e-5);
}

TEST_CASE("In a corner each wall has the plane that it would have alone, and what is not nearest has none") {
    Patch corner = wallOf(0.002, 0.0);
    const RegionSpheres flat = corner.spheres;
    for (size_t k = 0; k < flat.x.size(); ++k) { // the same wall upright, from y = 0 and x = 0
        corner.spheres.add({-kBall, flat.x[k], flat.y[k] + 0.02}, kBall);
    }
    const dvec3 leaf(kLeaf + 1e-4, 0.0007, kLeaf + 2e-4), x(1, 0, 0), z(0, 0, 1);
    SmoothPlane plane, alone;
    REQUIRE(corner.plane(leaf, plane, z));
    REQUIRE(wallOf(0.002, 0.0).plane(leaf, alone));
    CHECK(plane.normal == alone.normal);
    CHECK(plane.gap == alone.gap);
    REQUIRE(corner.plane(leaf, plane, x));
    CHECK(glm::dot(plane.normal, x) > 0.99999);
    CHECK(plane.gap == doctest::Approx(1e-4).epsilon(0.05));
    SmoothPlane farther = corner.tangent(leaf, z);
    farther.gap += 1e-4; // spheres of the same wall are nearer
    CHECK_FALSE(smoothPlane(corner.run(), {leaf, kLeaf}, farther, patchDepth(kTouch), plane));
}

TEST_CASE("One sphere alone and two opposite ones give no plane") {
    SmoothPlane plane;
    Patch one;
    one.spheres.add({0.0, 0.0, -kBall}, kBall);
    CHECK_FALSE(one.plane({0.0, 0.0, kLeaf}, plane));
    Patch slot;
    slot.spheres.add({0.0, 0.0, -kTouch - 1e-4}, kBall);
    slot.spheres.add({0.0, 0.0, kTouch + 1e-4}, kBall);
    CHECK_FALSE(slot.plane(dvec3(0.0), plane));
}
