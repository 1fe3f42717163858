// SPDX-License-Identifier: Apache-2.0
// Constraints of an arm besides region spheres, for every link: placed shapes, lines, leaves behind a
// surface. Also its grasp.
#include "tests/haptics/arm_proxy_world.h"

#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

Shape shapeOf(ShapeKind kind, const dvec3& at, const dvec3& size, bool keepIn = false) {
    Shape shape;
    shape.kind = kind;
    shape.baseTshape.position = at;
    shape.size = size;
    shape.keepIn = keepIn;
    return shape;
}

// Deepest overlap of any leaf with any of the shapes [m].
double depthIn(std::span<const Shape> shapes, const ArmModel& arm, const ArmFrames& frames) {
    double deepest = -1.0;
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        for (const Shape& shape : shapes) {
            deepest =
                std::max(deepest, -gapTo(shape, arm.centre(frames, i), arm.leaves[i].sphere.radius).gap);
        }
    }
    return deepest;
}

// A gripper's finger that slides along y at the end of an arm, from 0.1 to 0.
ArmModel armWithFinger() {
    ArmModel arm = makeArm(2, 4);
    ArmFinger finger;
    finger.joint = 2;
    finger.slides = true;
    finger.before.position = {0.3, 0.0, 0.0};
    finger.axis = {0.0, 1.0, 0.0};
    finger.open = 0.1;
    finger.closed = 0.0;
    arm.fingers.push_back(finger);
    arm.leaves.push_back({{dvec3(0.0), 0.01}, 2, 2, 1});
    arm.links.push_back("finger");
    return arm;
}

ArmInput still(const ArmProxy& proxy, const ContactSet* set, double grasp) {
    return {{proxy.tip(), 0.0, set, {}}, grasp};
}

} // namespace

TEST_CASE("No leaf of any link enters a forbidden shape or leaves a keep-in shape under a wild hand") {
    std::mt19937_64 random(21);
    const ArmModel arm = makeArm(5, 8);
    const std::vector<Shape> shapes{shapeOf(ShapeKind::Box, {0.5, 0.35, 0.0}, {0.3, 0.2, 0.4}),
                                    shapeOf(ShapeKind::Sphere, {0.9, -0.4, 0.1}, {0.1, 0.0, 0.0}),
                                    shapeOf(ShapeKind::Cylinder, {0.3, -0.4, 0.0}, {0.08, 0.5, 0.0}),
                                    shapeOf(ShapeKind::Box, {0.5, 0.0, 0.0}, {2.4, 2.0, 1.0}, true)};
    ArmProxy proxy(arm, Pose{}, {}, JointVector{}, shapes);
    REQUIRE(depthIn(shapes, arm, proxy.frames()) < 0.0);
    double deepest = -1.0;
    size_t touching = 0, trapped = 0;
    Pose target;
    for (int i = 0; i < 3000; ++i) {
        if (i % 250 == 0) {
            target = {randomIn(random, 1.2), randomRotation(random)};
        }
        const ArmStep tick = proxy.step(target, 0.05, nullptr);
        deepest = std::max(deepest, depthIn(shapes, arm, proxy.frames()));
        touching += tick.active.empty() ? 0 : 1;
        trapped += tick.trapped ? 1 : 0;
        for (const ActiveContact& active : tick.active) {
            CHECK(active.row.kind == ContactRow::Kind::Shape);
            CHECK(active.multiplier > 0.0);
        }
    }
    MESSAGE("deepest " << 1e6 * deepest << " um, in contact " << touching << " of 3000 ticks");
    CHECK(deepest <= 1e-9);
    CHECK(touching > 300);
    CHECK(trapped == 0);
}

TEST_CASE("A shape that appears over a link pushes it out by 1 mm per tick and never deeper") {
    const ArmModel arm = makeArm(4, 8);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{});
    const std::vector<Shape> shapes{shapeOf(ShapeKind::Sphere, {0.6, 0.075, 0.0}, {0.05, 0.0, 0.0})};
    proxy.setShapes(shapes);
    double before = depthIn(shapes, arm, proxy.frames());
    REQUIRE(before > 0.01);
    const Pose stays = proxy.tip();
    for (int i = 0; i < 200; ++i) {
        proxy.step(stays, 0.0, nullptr);
        const double now = depthIn(shapes, arm, proxy.frames());
        CHECK(now <= std::max(before, 0.0) + 1e-12);
        before = now;
    }
    CHECK(before <= 1e-6);
}

TEST_CASE("As many shapes as a scene has rows replace those of the start, and the last one holds") {
    const ArmModel arm = makeArm(4, 8);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{});
    std::vector<Shape> shapes(Scene::kMaxFixtures,
                              shapeOf(ShapeKind::Sphere, {9.0, 9.0, 9.0}, {0.01, 0.0, 0.0}));
    shapes.back() = shapeOf(ShapeKind::Sphere, {0.6, 0.075, 0.0}, {0.05, 0.0, 0.0});
    proxy.setShapes(shapes);
    CHECK(proxy.shapes().size() == shapes.size());
    REQUIRE(depthIn(shapes, arm, proxy.frames()) > 0.01);
    for (int i = 0; i < 200; ++i) {
        proxy.step(proxy.tip(), 0.0, nullptr);
    }
    CHECK(depthIn(shapes, arm, proxy.frames()) <= 1e-6);
}

TEST_CASE("A line constrains the tip of an arm: the tip moves to it and then slides only along it") {
    const ArmModel arm = makeArm(5, 2);
    std::vector<Shape> shapes{shapeOf(ShapeKind::Line, {0.0, 0.0, 0.0}, dvec3(0.0))};
    const JointVector bent{0.3, 0.5, -0.4, 0.6, 0.2};
    ArmFrames frames;
    arm.place(bent, Pose{}, frames);
    const dvec3 tip = arm.tip(frames).position;
    shapes[0].baseTshape = {tip + dvec3(0.01, -0.005, 0.0), {1.0, 0.0, 0.0, 0.0}}; // along z
    ArmProxy proxy(arm, Pose{}, {}, bent, shapes);
    const auto off = [&] {
        const dvec3 d = proxy.tip().position - shapes[0].baseTshape.position;
        return std::hypot(d.x, d.y);
    };
    double before = off();
    for (int i = 0; i < 400; ++i) {
        const dvec3 hand = tip + dvec3(0.05, 0.03, i < 200 ? 0.0 : 0.05);
        proxy.step({hand, kUpright}, 0.0, nullptr);
        const double now = off();
        CHECK(now <= std::max(before, 1e-9) + 1e-12);
        before = now;
    }
    CHECK(off() < 1e-7);
    CHECK(proxy.tip().position.z - tip.z > 0.03); // it slid
}

TEST_CASE("A leaf that new data put behind a surface is not held there and moves out towards the camera") {
    const ArmModel arm = makeArm(4, 8);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{});
    World world;
    // A wall of spheres just in front (in y) of the outer links: the camera is far away in +y.
    for (int i = 0; i < 25; ++i) {
        world.fixtures.spheres.add({0.5 + 0.02 * i, 0.02, 0.0}, 0.03);
    }
    world.grid.build(world.fixtures.spheres);
    const Pose stays = proxy.tip();
    const dvec3 towards(0.0, 1.0, 0.0);
    const double rest = 0.02 + 0.03 + 0.04; // y at which a leaf is clear in front
    for (int i = 0; i < 300; ++i) {
        world.query(arm, proxy);
        for (uint32_t leaf = 0; leaf < arm.leaves.size(); ++leaf) {
            const dvec3 at = arm.centre(proxy.frames(), leaf);
            if (at.x > 0.42 && at.y < rest) {
                world.set.behind.push_back({leaf, towards, rest - at.y});
            }
        }
        const ArmStep tick = proxy.step(stays, 0.0, &world.set);
        CHECK_FALSE(tick.trapped);
    }
    CHECK(arm.centre(proxy.frames(), arm.leaves.size() - 1).y > rest - 1e-3); // in front, not through
}

TEST_CASE("The grasp moves from open to closed at its own speed, and the finger's spheres follow") {
    const ArmModel arm = armWithFinger();
    ArmProxyOptions options;
    options.graspPerTick = 0.01;
    ArmProxy proxy(arm, Pose{}, options, JointVector{});
    const size_t tip = arm.leaves.size() - 1;
    CHECK(arm.centre(proxy.frames(), tip).y == doctest::Approx(0.1));
    for (int i = 0; i < 50; ++i) {
        proxy.step(still(proxy, nullptr, 1.0));
    }
    CHECK(proxy.posture().grasp == doctest::Approx(0.5));
    CHECK(arm.centre(proxy.frames(), tip).y == doctest::Approx(0.05));
    for (int i = 0; i < 60; ++i) {
        proxy.step(still(proxy, nullptr, 1.0));
    }
    CHECK(proxy.posture().grasp == doctest::Approx(1.0));
    proxy.step(still(proxy, nullptr, std::numeric_limits<double>::quiet_NaN()));
    CHECK(proxy.posture().grasp == doctest::Approx(1.0)); // unchanged
    for (int i = 0; i < 110; ++i) {
        proxy.step(still(proxy, nullptr, -3.0));
    }
    CHECK(proxy.posture().grasp == doctest::Approx(0.0));
}

TEST_CASE("A finger stops at a region and resumes when the region is gone") {
    const ArmModel arm = armWithFinger();
    ArmProxyOptions options;
    options.graspPerTick = 0.01;
    ArmProxy proxy(arm, Pose{}, options, JointVector{});
    World world;
    world.fixtures.spheres.add({0.55, 0.05, 0.0}, 0.025); // blocks only the finger
    world.grid.build(world.fixtures.spheres);
    double deepest = -1.0;
    size_t held = 0;
    for (int i = 0; i < 200; ++i) {
        world.query(arm, proxy);
        held += proxy.step(still(proxy, &world.set, 1.0)).graspHeld ? 1 : 0;
        deepest = std::max(deepest, world.depth(arm, proxy.frames()));
    }
    CHECK(deepest <= 1e-9);
    CHECK(held > 100);
    CHECK(proxy.posture().grasp > 0.1);
    CHECK(proxy.posture().grasp < 0.6);
    for (int i = 0; i < 200; ++i) {
        proxy.step(still(proxy, nullptr, 1.0));
    }
    CHECK(proxy.posture().grasp == doctest::Approx(1.0));
}
