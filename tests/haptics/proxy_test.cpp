// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/proxy.h"

#include "tests/haptics/proxy_rig.h"

#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

const dvec3 kAxisX(1, 0, 0), kAxisY(0, 1, 0);

HostFixtures flatWall(double z, uint64_t generation = 1) {
    HostFixtures fixtures = emptySet(generation);
    addWall(fixtures, dvec3(0, 0, z), kAxisX, kAxisY, 0.12, 0.004, 0.04);
    return fixtures;
}

Pose at(double x, double y, double z) {
    return {dvec3(x, y, z), kUpright};
}

// Steps until nothing overlaps. Checks that no depth grows and that a tick reduces the deepest by at most 1
// mm. Returns the number of ticks, or limit.
int turnsToLeave(ProxyRig& rig, const Pose& target, int limit) {
    double depth = rig.depth();
    for (int k = 1; k <= limit; ++k) {
        const ProxyStep tick = rig.step(target);
        const double now = rig.depth();
        CHECK(now <= std::max(0.0, depth));
        CHECK(tick.escape == (depth > 1e-9));
        depth = now;
        if (depth <= 0.0) {
            return k;
        }
    }
    return limit;
}

} // namespace

TEST_CASE("In free space the tool reaches the hand's pose exactly, rotation included") {
    std::mt19937_64 random(31);
    ProxyRig rig(randomTool(random, 20, 0.05, 0.01), emptySet(), at(0, 0, 0));
    const Pose target{dvec3(0.0311, -0.02, 0.0174), randomRotation(random)};
    int ticks = 0;
    while (ticks < 100 && !(rig.proxy().pose().position == target.position)) {
        rig.step(target);
        ++ticks;
    }
    CHECK(ticks < 40);
    CHECK(rig.proxy().pose().rotation == glm::normalize(target.rotation));
    const ProxyStep rest = rig.step(target);
    CHECK(rest.solves == 1);
    CHECK(!rest.contact);
    CHECK(rest.minGap == rig.inForce().reach);
    CHECK(rest.pose.position == target.position);
}

TEST_CASE("A scene without regions from points needs no contact set") {
    Proxy proxy(ballTool(0.01), {}, {}, at(1000, 0, 0));
    ProxyStep tick = proxy.step({at(1000, 0.001, 0), 0.1, nullptr, {}});
    CHECK(tick.pose.position == dvec3(1000, 0.001, 0));
    CHECK(!tick.stalled);
}

TEST_CASE("Along a forbidden plane no tangential motion is lost, and the tool rests on it within the skin") {
    Shape plane;
    plane.kind = ShapeKind::Plane;
    Proxy proxy(ballTool(0.01), std::span(&plane, 1), {}, at(0, 0, 0.0101));
    for (int k = 1; k <= 500; ++k) {
        const double x = 0.003 * k; // 3 m/s, with the hand 10 m below the surface, which must not slow it
        const ProxyStep tick = proxy.step({at(x, 0, -10.0), 0.1, nullptr, {}});
        CHECK(tick.contact);
        CHECK(tick.pose.position.x == doctest::Approx(x).epsilon(1e-9));
        CHECK(tick.pose.position.z >= 0.01);
    }
    CHECK(proxy.pose().position.z == doctest::Approx(0.01).epsilon(1e-5));
}

TEST_CASE("Along a wall of region spheres the tool keeps up with the hand") {
    ProxyRig rig(ballTool(0.01), flatWall(0.0), at(-0.08, 0.0005, 0.0506));
    double worstLag = 0.0;
    for (int k = 0; k < 160; ++k) {
        const double x = -0.08 + 0.001 * k; // 1 m/s, 5 mm deep
        rig.step(at(x, 0.0005, 0.045));
        worstLag = std::max(worstLag, std::abs(rig.proxy().pose().position.x - x));
        REQUIRE(rig.depth() <= 0.0);
    }
    MESSAGE("worst lag along the wall [m]: " << worstLag);
    CHECK(worstLag < 5e-4); // the dimples of the wall pull towards their centre
}

TEST_CASE("No leaf travels farther than the step cap in a solve, for any target") {
    std::mt19937_64 random(33);
    for (const uint32_t solves : {1u, 2u, 4u}) {
        ProxyOptions options;
        options.solves = solves;
        options.stepCap = 0.0015;
        ProxyRig rig(randomTool(random, 50, 0.1, 0.01), emptySet(), at(0, 0, 0), options, {}, 0.05);
        const LeafPlaces places(rig.tool());
        LeafCentres before(50), after(50);
        double longest = 0.0;
        for (int k = 0; k < 300; ++k) {
            places.place(rig.proxy().pose(), dvec3(0.0), before);
            rig.step({randomIn(random, 1.0), randomRotation(random)});
            places.place(rig.proxy().pose(), dvec3(0.0), after);
            longest = std::max(longest, leafDisplacement(before, after));
        }
        CHECK(longest <= solves * 0.0015 * (1.0 + 1e-9));
        CHECK(longest > 0.9 * 0.0015);
    }
}

TEST_CASE("New data over the tool pushes it out by 1 mm per tick, and no depth ever grows") {
    for (const double over : {0.005, 0.012, 0.02, 0.03, 0.045}) {
        ProxyRig rig(ballTool(0.01), flatWall(-0.001), at(0.001, 0.0013, 0.0501));
        rig.replace(flatWall(over, 2));
        const double depth = rig.depth();
        REQUIRE(depth > over - 0.002);
        const int ticks = turnsToLeave(rig, rig.proxy().pose(), 200);
        MESSAGE((over * 1e3) << " mm: " << ticks << " ticks");
        CHECK(ticks >= static_cast<int>(depth / 0.002)); // at most 2 mm of travel per tick
        CHECK(ticks <= static_cast<int>(std::ceil(depth / 0.001)) + 3);
        CHECK(rig.proxy().pose().position.z > over);
    }
}

TEST_CASE("A tool with many leaves also leaves new data, pressed or not") {
    std::mt19937_64 random(34);
    const Tool tool = randomTool(random, 60, 0.03, 0.008);
    for (const double press : {0.0, 0.01, 10.0}) {
        ProxyRig rig(tool, flatWall(-0.03), at(0, 0, 0.055));
        REQUIRE(rig.depth() < 0.0);
        rig.replace(flatWall(0.0, 2));
        const double depth = rig.depth();
        REQUIRE(depth > 0.01);
        Pose target = rig.proxy().pose();
        target.position.z -= press;
        const int ticks = turnsToLeave(rig, target, 200);
        MESSAGE("depth " << depth * 1e3 << " mm, pressed " << press << " m: " << ticks << " ticks");
        CHECK(ticks <= static_cast<int>(std::ceil(depth / 0.001)) + 8);
    }
}

TEST_CASE(
    "Between two walls without clearance the tool is trapped and held, and leaves when one is removed") {
    HostFixtures squeeze = flatWall(0.0, 2);
    addWall(squeeze, dvec3(0, 0, 0.095), kAxisX, kAxisY, 0.12, 0.004, 0.04);
    ProxyRig rig(ballTool(0.01), flatWall(-0.003), at(0.002, 0.002, 0.0475));
    rig.replace(squeeze); // 2.5 mm of overlap on either side
    const double depth = rig.depth();
    REQUIRE(depth > 0.002);
    for (int k = 0; k < 50; ++k) {
        const Pose before = rig.proxy().pose();
        const ProxyStep tick = rig.step(at(0.05, 0, 0.0475));
        CHECK(tick.trapped);
        CHECK(tick.pose.position == before.position);
        CHECK(!tick.contact);
    }
    rig.replace(flatWall(0.0, 3));
    CHECK(turnsToLeave(rig, at(0.002, 0.002, 0.0475), 20) <= 6);
    const ProxyStep tick = rig.step(at(0.002, 0.002, 0.0475));
    CHECK(!tick.trapped);
}

TEST_CASE(
    "Without answers the tool stops at the edge of the trust region, can move back, and reports the stall") {
    ProxyRig rig(ballTool(0.01), flatWall(-1.0), at(0, 0, 0));
    uint64_t stalled = 0;
    for (int k = 0; k < 20; ++k) {
        stalled += rig.step(at(0.1, 0, 0), 0, true).stalled ? 1 : 0;
    }
    CHECK(stalled >= 15);
    CHECK(rig.proxy().pose().position.x <= 0.01 - 1e-5 + 1e-12);
    CHECK(rig.proxy().pose().position.x > 0.0099);
    const ProxyStep back = rig.step(at(0.001, 0, 0), 0, true);
    CHECK(!back.stalled);
    CHECK(back.pose.position.x < 0.005);
    CHECK(rig.step(at(0.001, 0, 0), 0, true).pose.position == dvec3(0.001, 0, 0));
}

TEST_CASE("A set that was made too far away is not accepted") {
    ProxyRig rig(ballTool(0.01), flatWall(0.0), at(0, 0, 0.06));
    ContactSet far = rig.inForce();
    rig.proxy().setPose(at(0, 0.0, 0.0705));
    CHECK(!rig.proxy().accepts(far));
    rig.proxy().setPose(at(0, 0.0, 0.065));
    CHECK(rig.proxy().accepts(far));
}

TEST_CASE("The step ends at its deadline, after at least one solve") {
    ProxyRig rig(ballTool(0.01), emptySet(), at(0, 0, 0));
    const auto always = [](const void*) { return true; };
    const ProxyStep tick = rig.proxy().step({at(0.1, 0, 0), 0.1, &rig.inForce(), {always, nullptr}});
    CHECK(tick.solves == 1);
    CHECK(tick.pose.position.x == doctest::Approx(0.002));
}

TEST_CASE("A target that is not finite, or a set of another tool, holds the tool") {
    ProxyRig rig(ballTool(0.01), emptySet(), at(0, 0, 0));
    Pose bad = at(std::numeric_limits<double>::quiet_NaN(), 0, 0);
    CHECK(rig.step(bad).pose.position == dvec3(0.0));
    bad = at(0, 0, 0);
    bad.rotation = {0, 0, 0, 0};
    CHECK(rig.step(bad).pose.position == dvec3(0.0));
    const ContactSet foreign;
    CHECK(rig.proxy().step({at(0.1, 0, 0), 0.1, &foreign, {}}).pose.position == dvec3(0.0));
    rig.proxy().setPose(bad);
    CHECK(isFinite(rig.proxy().pose()));
    CHECK(rig.proxy()
              .step({at(0.001, 0, 0), std::numeric_limits<double>::quiet_NaN(), &rig.inForce(), {}})
              .solves > 0);
}

TEST_CASE("Multipliers times active rows equal M (x - x_u)") {
    ProxyRig rig(ballTool(0.01), flatWall(0.0), at(0.001, 0.0005, 0.0503));
    ProxyStep tick;
    for (int k = 0; k < 20; ++k) {
        tick = rig.step(at(0.001, 0.0005, 0.04));
    }
    REQUIRE(tick.contact);
    dvec3 push{0.0};
    for (const ActiveContact& c : tick.active) {
        CHECK(c.multiplier > 0.0);
        CHECK(c.row.normal.z > 0.9);
        push += c.multiplier * c.row.normal;
    }
    CHECK(glm::distance(push, tick.pose.position - dvec3(0.001, 0.0005, 0.04)) < 1e-6);
    CHECK(tick.minGap >= 0.0);
    CHECK(tick.minGap < 1e-6);
}

TEST_CASE("Tools of 1000 leaves flat on a wall do not enter it although there are more contacts than rows") {
    std::vector<Sphere> leaves;
    for (int i = 0; i < 32; ++i) {
        for (int j = 0; j < 32; ++j) {
            leaves.push_back({dvec3(0.006 * (i - 15.5), 0.006 * (j - 15.5), 0.0), 0.005});
        }
    }
    ProxyRig rig(makeTool(leaves), flatWall(0.0), at(0, 0, 0.047));
    for (int k = 0; k < 40; ++k) {
        rig.step({dvec3(0.0005 * k, 0, 0.02), rotationExp(dvec3(0.2, 0.1, 0.3))});
        REQUIRE(rig.depth() <= 0.0);
    }
    CHECK(rig.depth() > -1e-4);
}
