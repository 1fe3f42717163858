// SPDX-License-Identifier: Apache-2.0
// What a tool does while it slides: friction as a play, and smooth planes over the spheres.
#include "tests/haptics/proxy_rig.h"
#include "tests/support/sanitized.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

HostFixtures lattice() {
    HostFixtures wall = emptySet();
    addWall(wall, {0.0, 0.0, -0.04}, {1, 0, 0}, {0, 1, 0}, 0.06, 0.004, 0.04);
    return wall;
}

Tool ball() {
    const Sphere sphere{{0.0, 0.0, 0.0}, 0.01};
    return Tool(buildSphereTree({&sphere, 1}));
}

Pose handAt(double x) {
    return {{x, 0.001, -0.01}, kUpright}; // 20 mm below the resting place
}

ProxyOptions sliding(double friction, bool smooth) {
    ProxyOptions options;
    options.friction = friction;
    options.rows.smooth = smooth;
    return options;
}

// Half of the peak-to-peak lateral distance between hand and tool [m] along 20 mm at 0.1 m/s.
double sawtooth(ProxyRig& rig) {
    double low = 1.0, high = -1.0;
    for (int k = 0; k < 400; ++k) {
        const Pose hand = handAt(-0.02 + 1e-4 * k);
        const double lateral = rig.step(hand).allowed.position.x - hand.position.x;
        REQUIRE(rig.depth() <= 0.0);
        low = k < 100 ? low : std::min(low, lateral);
        high = k < 100 ? high : std::max(high, lateral);
    }
    return 0.5 * (high - low);
}

// As sawtooth(), along a corner with the hand 20 mm inside of each of its two walls.
double sawtoothInCorner(bool smooth) {
    constexpr double kRadius = 0.02, kSpacing = 0.003; // [m]
    HostFixtures corner = emptySet();
    addWall(corner, {0.0, 0.0, -kRadius}, {1, 0, 0}, {0, 1, 0}, 0.06, kSpacing, kRadius);
    addWall(corner, {kRadius, 0.0, 0.0}, {0, 0, 1}, {0, 1, 0}, 0.06, kSpacing, kRadius);
    ProxyRig rig(ball(), corner, {{-0.012, -0.03, 0.012}, kUpright}, sliding(0.0, smooth));
    double low = 1.0, high = -1.0;
    for (int k = 0; k < 400; ++k) {
        const Pose hand{{0.01, 1e-4 * k - 0.03, -0.01}, kUpright};
        const double lateral = rig.step(hand).allowed.position.y - hand.position.y;
        REQUIRE(rig.depth() <= 0.0);
        low = k < 100 ? low : std::min(low, lateral);
        high = k < 100 ? high : std::max(high, lateral);
    }
    return 0.5 * (high - low);
}

} // namespace

TEST_CASE(
    "A ball that slides 20 mm deep over a lattice of spheres feels a sawtooth, and none on smooth planes") {
    ProxyRig bumpy(ball(), lattice(), handAt(-0.02), sliding(0.0, false));
    ProxyRig smooth(ball(), lattice(), handAt(-0.02), sliding(0.0, true));
    for (ProxyRig* rig : {&bumpy, &smooth}) {
        rig->proxy().setPose({{-0.02, 0.001, 0.02}, kUpright});
    }
    const double before = sawtooth(bumpy), after = sawtooth(smooth);
    CHECK(before > 5e-4); // 0.5 N at 1000 N/m
    CHECK(after < 3e-5);  // 0.03 N
}

TEST_CASE("In a corner of two walls smooth planes take the sawtooth away as on one wall") {
    CHECK(sawtoothInCorner(false) > 1e-3); // 1 N at 1000 N/m
    CHECK(sawtoothInCorner(true) < 1e-4);
}

TEST_CASE("Smooth planes do not narrow a slot: a ball with 0.2 mm of room follows the hand through it") {
    HostFixtures slot = emptySet();
    addWall(slot, {-0.0501, 0.0, 0.0}, {0, 0, 1}, {0, 1, 0}, 0.05, 0.004, 0.04);
    addWall(slot, {0.0501, 0.0, 0.0}, {0, 0, 1}, {0, 1, 0}, 0.05, 0.004, 0.04);
    ProxyRig rig(ball(), slot, {{0.0, -0.1, 0.0}, kUpright}, sliding(0.0, true));
    for (int k = 0; k < 1500; ++k) {
        const double y = -0.1 + 1e-4 * k;
        REQUIRE(rig.step({{0.0, y, 0.0}, kUpright}).pose.position.y == doctest::Approx(y).epsilon(1e-3));
    }
}

TEST_CASE("With friction the tool stays behind the hand by mu times its depth, either way, and at rest") {
    ProxyRig rig(ball(), lattice(), {{0.0, 0.001, 0.02}, kUpright}, sliding(0.2, true));
    for (int k = 0; k < 100; ++k) {
        rig.step(handAt(0.0));
    }
    const double depth = rig.proxy().pose().position.z - handAt(0.0).position.z;
    double there = 0.0, back = 0.0, rest = 0.0;
    for (int k = 1; k <= 150; ++k) {
        there = handAt(1e-4 * k).position.x - rig.step(handAt(1e-4 * k)).allowed.position.x;
    }
    for (int k = 1; k <= 50; ++k) { // a still hand: nothing moves
        rest = handAt(0.015).position.x - rig.step(handAt(0.015)).allowed.position.x;
    }
    for (int k = 1; k <= 150; ++k) {
        back = handAt(0.015 - 1e-4 * k).position.x - rig.step(handAt(0.015 - 1e-4 * k)).allowed.position.x;
    }
    CHECK(there == doctest::Approx(0.2 * depth).epsilon(0.05));
    CHECK(rest == doctest::Approx(there).epsilon(0.02));
    CHECK(back == doctest::Approx(-0.2 * depth).epsilon(0.05));
}

TEST_CASE("With friction a bar slides evenly, also where it touches spheres of one wall at several angles") {
    std::vector<Sphere> leaves;
    for (int i = -3; i <= 3; ++i) {
        leaves.push_back({{0.015 * i, 0.0, 0.0}, 0.008});
    }
    for (const double friction : {0.1, 0.3, 1.0}) {
        CAPTURE(friction);
        ProxyRig rig(makeTool(leaves), lattice(), {{-0.02, 0.001, 0.02}, kUpright}, sliding(friction, true));
        double jump = 0.0, most = 0.0, before = 0.0;
        for (int k = 0; k < 800; ++k) {
            const Pose hand{{5e-5 * k - 0.02, 0.001 + 1e-5 * k, 0.0}, kUpright}; // 8 mm deep
            const ProxyStep step = rig.step(hand);
            REQUIRE(rig.depth() <= 0.0);
            const double lateral = hand.position.x - step.allowed.position.x;
            jump = k < 200 ? jump : std::max(jump, std::abs(lateral - before));
            most = std::max(most, lateral);
            before = lateral;
        }
        CHECK(jump < 3e-4 * (1.0 + friction)); // 0.3 N at 1000 N/m
        CHECK(most > 0.7 * friction * 0.008);
        CHECK(most < 1.3 * friction * 0.008);
    }
}

TEST_CASE("A tool dragged over a noisy wall of 60 k spheres never enters it") {
    std::mt19937_64 random(21);
    HostFixtures fixtures = emptySet();
    std::normal_distribution<double> noise(0.0, 0.0003);
    addWall(fixtures, dvec3(0.0), dvec3(1, 0, 0), dvec3(0, 1, 0), 0.2144, 0.00175, 0.04);
    for (float& z : fixtures.spheres.z) { // a bulging, noisy surface
        const size_t i = static_cast<size_t>(&z - fixtures.spheres.z.data());
        const double x = fixtures.spheres.x[i], y = fixtures.spheres.y[i];
        z = static_cast<float>(0.01 * std::sin(20.0 * x) * std::cos(17.0 * y) + noise(random));
    }
    const Tool tool = randomTool(random, 256, 0.06, 0.008);
    for (const double speed : {0.05, 0.3, 2.0}) {
        ProxyRig rig(tool, fixtures, {dvec3(0, 0, 0.16), kUpright});
        const int ticks = kSanitized ? 400 : 3000, pressed = 300;
        int contact = 0;
        Pose hand = rig.proxy().pose();
        for (int k = 0; k < ticks; ++k) {
            // Presses the tool 2 mm in and drags it around.
            const double a = speed / 0.08 * 0.001 * k;
            hand.position = dvec3(0.08 * std::cos(a), 0.08 * std::sin(a), k < 200 ? 0.16 - 0.001 * k : 0.0);
            hand.position.z = std::max(hand.position.z, rig.proxy().pose().position.z - 0.002);
            hand.rotation = rotationExp(dvec3(0.3 * std::sin(a), 0.3 * std::cos(1.3 * a), 0.0));
            rig.query();
            const ProxyStep tick = rig.turnOnly(hand);
            contact += k >= pressed && tick.contact ? 1 : 0;
            REQUIRE(tick.minGap >= 0.0);
        }
        CHECK(contact > (ticks - pressed) / 2);
    }
}
