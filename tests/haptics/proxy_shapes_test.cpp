// SPDX-License-Identifier: Apache-2.0
// The proxy with placed shapes, and with leaves that a new frame put behind a surface.
#include "engine/haptics/proxy.h"

#include "tests/contact/images.h"
#include "tests/haptics/proxy_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

Pose at(const dvec3& p) {
    return {p, kUpright};
}

Tool rod() {
    return makeTool({{dvec3(0, 0, -0.03), 0.005}, {dvec3(0, 0, 0.0), 0.006}, {dvec3(0, 0, 0.04), 0.004}});
}

double deepest(const Shape& shape, const Tool& tool, const Pose& pose) {
    double depth = -1e9;
    for (const Sphere& leaf : tool.leaves()) {
        depth = std::max(depth, -gapTo(shape, pose.apply(leaf.centre), leaf.radius).gap);
    }
    return depth;
}

} // namespace

TEST_CASE("No hand pushes the tool into a forbidden shape or out of a keep-in shape") {
    std::mt19937_64 random(61);
    const Tool tool = rod();
    for (const ShapeKind kind : {ShapeKind::Sphere, ShapeKind::Box, ShapeKind::Plane, ShapeKind::Cylinder}) {
        for (const bool keepIn : {false, true}) {
            Shape shape;
            shape.kind = kind;
            shape.keepIn = keepIn;
            shape.size = dvec3(0.2, 0.25, 0.3);
            shape.baseTshape = {dvec3(4000.0, -0.2, 0.3), randomRotation(random)};
            const dvec3 start =
                keepIn ? dvec3(0, 0, kind == ShapeKind::Plane ? -0.1 : 0.0) : dvec3(0, 0, 0.4);
            const Pose home = at(shape.baseTshape.apply(start));
            Proxy proxy(tool, std::span(&shape, 1), {}, home);
            REQUIRE(deepest(shape, tool, proxy.pose()) < 0.0);
            double worst = -1.0;
            uint64_t contact = 0, bisected = 0;
            Pose target = home;
            for (int k = 0; k < 3000; ++k) {
                if (k % 40 == 0) {
                    const double far = k % 400 == 0 ? 10.0 : 0.3;
                    target = {shape.baseTshape.position + randomIn(random, far), randomRotation(random)};
                }
                const ProxyStep tick = proxy.step({target, 0.03, nullptr, {}});
                worst = std::max(worst, deepest(shape, tool, tick.pose));
                contact += tick.contact ? 1 : 0;
                bisected += tick.bisected;
            }
            MESSAGE(static_cast<int>(kind) << std::string(keepIn ? " keep in" : " forbidden") << ": deepest "
                                           << worst << " contact " << contact << " bisected " << bisected);
            CHECK(worst <= 0.0);
            CHECK(contact > 100);
        }
    }
}

TEST_CASE("A plate with more leaves than the solver has rows rolls over its edges and slides on a plane") {
    std::vector<Sphere> leaves;
    for (int i = 0; i < 4096; ++i) {
        const int row = i / 64;
        leaves.push_back({dvec3(0.001 * (i % 64) - 0.0315, 0.001 * row - 0.0315, 0.0), 0.001});
    }
    const Tool plate = makeTool(leaves);
    Shape ground; // z <= 0 is forbidden
    ground.kind = ShapeKind::Plane;
    Proxy proxy(plate, std::span(&ground, 1), {}, at({0.0, 0.0, 0.02}));
    double deep = -1.0, off = 0.0;
    uint32_t bisected = 0;
    for (int k = 0; k < 600;
         ++k) { // the hand moves sideways and presses one edge after another into the plane
        const double t = 0.001 * k, tilt = k < 100 ? 0.0 : 0.1;
        const Pose hand{{0.2 * t, -0.1 * t, 0.0},
                        rotationExp({tilt * std::sin(20.0 * t), tilt * std::cos(20.0 * t), 0.0})};
        const ProxyStep tick = proxy.step({hand, 0.06, nullptr, {}});
        deep = std::max(deep, deepest(ground, plate, tick.pose));
        bisected += tick.bisected;
        const dvec3 lag = tick.pose.position - hand.position;
        off = std::max(off, k >= 100 ? std::hypot(lag.x, lag.y) : 0.0);
    }
    CHECK(deep <= 0.0);
    CHECK(off < 0.001);
    CHECK(bisected < 10);
    MESSAGE("largest lag along the plane ", 1e3 * off, " mm, ", bisected, " ticks bisected");
}

TEST_CASE("Of leaves that are equally near to a shape, an even selection gets rows, after all nearer ones") {
    NearShapes near(100, 2);
    for (uint32_t leaf = 0; leaf < 100; ++leaf) {
        near.add(0, leaf, leaf % 10 == 0 ? 0.0005 : 0.001);
    }
    near.add(1, 7, 0.0);
    REQUIRE_FALSE(near.select(41));
    uint32_t rows = 0, nearest = 0, firstHalf = 0;
    for (const NearShapes::Pair& pair : near.pairs()) {
        rows += pair.row;
        nearest += pair.row && pair.gap < 0.001;
        firstHalf += pair.row && pair.gap == 0.001 && pair.leaf < 50;
    }
    CHECK(rows == 41);
    CHECK(nearest == 11);
    CHECK(firstHalf == 15);
    CHECK(near.select(101));
    CHECK(near.pairs()[99].row);
    near.clear();
    CHECK(near.select(0));
}

TEST_CASE("A tick that is late solves once, does not tighten twice and still lets no leaf into a shape") {
    const Tool tool = rod();
    Shape ball;
    ball.kind = ShapeKind::Sphere;
    ball.size = dvec3(0.05, 0.0, 0.0);
    Proxy proxy(tool, std::span(&ball, 1), {}, at({0.0, 0.0, 0.2}));
    const Deadline late{[](const void*) { return true; }, nullptr};
    std::mt19937_64 random(5);
    double worst = -1.0;
    uint32_t contact = 0;
    for (int k = 0; k < 2000; ++k) {
        const ProxyStep tick =
            proxy.step({{randomIn(random, 0.03), randomRotation(random)}, 0.03, nullptr, late});
        CHECK(tick.solves <= 1);
        CHECK(tick.rounds <= 1);
        worst = std::max(worst, deepest(ball, tool, tick.pose));
        contact += tick.contact ? 1 : 0;
    }
    CHECK(worst <= 0.0);
    CHECK(contact > 1000);
}

TEST_CASE("A shape that already contains the tool pushes it out by 1 mm per tick and never deeper") {
    Shape box;
    box.kind = ShapeKind::Box;
    box.size = dvec3(0.2);
    Proxy proxy(ballTool(0.01), std::span(&box, 1), {}, at(dvec3(0.085, 0, 0)));
    double depth = 0.025;
    for (int k = 0; k < 30; ++k) {
        const ProxyStep tick = proxy.step({at(dvec3(0.0, 0.05, 0)), 0.03, nullptr, {}});
        const double now = -gapTo(box, proxy.pose().position, 0.01).gap;
        CHECK(now <= std::max(0.0, depth));
        CHECK(now >= depth - 0.001 - 1e-6);
        CHECK(tick.escape == (depth > 1e-9));
        depth = now;
    }
    CHECK(depth <= 0.0);
    CHECK(proxy.pose().position.y == doctest::Approx(0.05));
}

TEST_CASE("The tool's centre stays on a line, follows the hand along it and rotates freely") {
    std::mt19937_64 random(62);
    Shape line;
    line.kind = ShapeKind::Line;
    line.baseTshape = {randomIn(random, 0.5), randomRotation(random)};
    const dvec3 along = line.baseTshape.rotation * dvec3(0, 0, 1);
    const Tool tool = rod();
    Proxy proxy(tool, std::span(&line, 1), {}, at(line.baseTshape.apply(dvec3(0.0))));
    double worst = 0.0;
    for (int k = 1; k <= 1000; ++k) {
        const Pose hand{line.baseTshape.apply(dvec3(0.05 * std::sin(0.01 * k), 0.03, 0.001 * k)),
                        randomRotation(random)};
        proxy.step({hand, 0.03, nullptr, {}});
        const dvec3 offset = proxy.pose().position - line.baseTshape.position;
        worst = std::max(worst, glm::length(offset - glm::dot(offset, along) * along));
    }
    CHECK(worst < 2e-9);
    for (int k = 0; k < 200; ++k) {
        proxy.step({at(line.baseTshape.apply(dvec3(0.02, 0.01, 1.0))), 0.03, nullptr, {}});
    }
    CHECK(glm::distance(proxy.pose().position, line.baseTshape.apply(dvec3(0, 0, 1.0))) < 1e-8);
    CHECK(glm::length(rotationLog(proxy.pose().rotation)) < 1e-6);
}

TEST_CASE("A tool off the line or tilted off the axis is pulled back by at most 1 mm per tick") {
    Shape axis;
    axis.kind = ShapeKind::Axis;
    const Tool tool = rod();
    Proxy proxy(tool, std::span(&axis, 1), {}, {dvec3(0.01, 0, 0), rotationExp(dvec3(0.3, 0.2, 0.4))});
    double off = 0.01;
    for (int k = 0; k < 60; ++k) {
        const ProxyStep tick = proxy.step({at(dvec3(0.3, 0.2, 0.0)), 0.03, nullptr, {}});
        const double now = std::hypot(tick.pose.position.x, tick.pose.position.y);
        CHECK(!tick.trapped);
        CHECK(now <= std::max(off, 2e-9));
        CHECK(now >= off - 0.002);
        off = now;
    }
    CHECK(off < 2e-9);
    CHECK(glm::distance(proxy.pose().rotation * dvec3(0, 0, 1), dvec3(0, 0, 1)) < 1e-8);
}

TEST_CASE("A surface that jumps past the tool moves it out on the camera's side, not through the surface") {
    for (const double noise : {0.0, 0.0005}) {
        for (const double jump : {0.03, 0.045, 0.05, 0.052, 0.054, 0.056, 0.0575, 0.06, 0.08, 0.12}) {
            ProxyRig rig(ballTool(0.01), wallImage(0.5, 1, 0.04, noise), at(dvec3(0.002, 0.001, 0.445)));
            REQUIRE(rig.depth() < 0.0);
            rig.step(rig.proxy().pose());
            const double front = 0.5 - jump;
            rig.replace(wallImage(front, 2, 0.04, noise));
            int ticks = 0;
            bool flagged = false;
            while (ticks < 400 && !(rig.depth() <= 0.0 && rig.proxy().pose().position.z < front)) {
                rig.step(at(dvec3(0.002, 0.001, 0.445)));
                flagged = flagged || !rig.inForce().behind.empty();
                ++ticks;
            }
            MESSAGE("noise " << noise << " jump " << (jump * 1e3) << " mm: " << ticks << " ticks, flagged "
                             << flagged << ", ends " << (front - rig.proxy().pose().position.z) * 1e3
                             << " mm in front");
            CHECK(ticks < 400);
            CHECK(ticks >= static_cast<int>((jump - 0.012) / 0.002));
            CHECK(front - rig.proxy().pose().position.z > 0.045);
        }
    }
}

TEST_CASE("Between oblique surfaces of new data a tool escapes by at most the step cap in a tick") {
    for (const double period : {0.001, 0.00025}) {
        HostFixtures wedge = emptySet(1);
        wedge.spheres.add({0.03, 0, 0}, 0.04);
        wedge.spheres.add({-0.03, 0, 0}, 0.04);
        ProxyOptions options;
        options.period = period;
        ProxyRig rig(ballTool(0.01), wedge, at(dvec3(0, 0, 0.005)), options);
        double last = 0.005, fastest = 0.0;
        for (int tick = 0; tick < 200; ++tick) {
            const double z = rig.step(at(dvec3(0, 0, 0.005))).pose.position.z;
            fastest = std::max(fastest, z - last);
            last = z;
        }
        CHECK(fastest > 1.5 * ProxyOptions::kEscapeSpeed * period);
        CHECK(fastest < 1.0001 * options.stepCap);
    }
}

TEST_CASE("A surface that appears far in front of the tool leaves it where it is") {
    for (const double noise : {0.0, 0.0005}) {
        const dvec3 start(0.002, 0.001, 0.445);
        ProxyRig rig(ballTool(0.01), wallImage(0.5, 1, 0.04, noise), at(start));
        rig.step(rig.proxy().pose());
        rig.replace(wallImage(0.33, 2, 0.04, noise));
        for (int tick = 0; tick < 50; ++tick) {
            rig.step(at(start));
            CHECK(rig.inForce().behind.empty());
        }
        CHECK(rig.depth() < 0.0);
        CHECK(glm::distance(rig.proxy().pose().position, start) < 1e-9);
    }
}
