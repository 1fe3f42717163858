// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/arm_proxy.h"

#include "engine/haptics/arm_damping.h"
#include "tests/haptics/allocation_count.h"
#include "tests/haptics/arm_proxy_world.h"
#include "tests/support/sanitized.h"

#include <doctest/doctest.h>
#include <limits>

using namespace fathom;
using namespace fathom::testing;

namespace {

double worstLimit(const ArmModel& arm, const JointVector& q) {
    double worst = 0.0;
    for (size_t k = 0; k < arm.count(); ++k) {
        worst = std::max({worst, arm.joints[k].lower - q[k], q[k] - arm.joints[k].upper});
    }
    return worst;
}

} // namespace

TEST_CASE("A joint's motion of a point is the derivative of the point's position") {
    ArmModel arm = makeArm(5, 1);
    arm.joints[2].slides = true;
    const JointVector q{0.3, -0.5, 0.1, 0.7, -0.2};
    ArmFrames frames, moved;
    const Pose base{{1.0, 2.0, 3.0}, rotationExp({0.1, 0.2, -0.3})};
    arm.place(q, base, frames);
    const dvec3 tip = arm.tip(frames).position;
    for (size_t k = 0; k < 5; ++k) {
        JointVector next = q;
        next[k] += 1e-7;
        arm.place(next, base, moved);
        const dvec3 slope = (arm.tip(moved).position - tip) / 1e-7;
        CHECK(glm::distance(slope, arm.motionOf(frames, k, tip)) < 1e-6);
    }
}

TEST_CASE("An arm with four to twelve joints moves its tip to a reachable position") {
    for (size_t joints : {4u, 5u, 6u, 7u, 12u}) {
        const ArmModel arm = makeArm(joints, 3);
        ArmProxy proxy(arm, Pose{}, {}, JointVector{0.2, 0.3, -0.2, 0.4, 0.1, -0.3, 0.2});
        ArmFrames frames;
        arm.place(JointVector{-0.3, 0.6, 0.3, 0.5, 0.4, 0.2, -0.1}, Pose{}, frames);
        ArmStep tick;
        for (int i = 0; i < 4000; ++i) {
            tick = proxy.step(arm.tip(frames), 0.0, nullptr);
        }
        INFO(joints << " joints, residual " << tick.residual);
        CHECK(tick.residual < 1e-6);
        CHECK_FALSE(tick.trapped);
    }
}

TEST_CASE("An arm that is at its target reports a distance of exactly 0") {
    const ArmModel arm = makeArm(6, 1);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{0.2, 0.3, -0.2, 0.4, 0.1, -0.3});
    ArmFrames frames;
    arm.place(proxy.joints(), Pose{}, frames);
    for (int i = 0; i < 3; ++i) {
        CHECK(proxy.step(arm.tip(frames), 0.1, nullptr).residual == 0.0);
    }
}

TEST_CASE("No joint exceeds its position or speed limits for any hand motion") {
    std::mt19937_64 random(5);
    for (size_t joints : {1u, 4u, 7u, 12u}) {
        const ArmModel arm = makeArm(joints, 2, 0.4);
        ArmProxy proxy(arm, Pose{}, {}, JointVector{});
        double worst = 0.0, fastest = 0.0;
        size_t limited = 0;
        Pose target;
        for (int i = 0; i < 3000; ++i) {
            if (i % 300 == 0) {
                target = {randomIn(random, 2.0), randomRotation(random)};
            }
            const JointVector before = proxy.joints();
            const ArmStep tick = proxy.step(target, 0.1, nullptr);
            worst = std::max(worst, worstLimit(arm, tick.q));
            limited += tick.atLimits > 0 ? 1 : 0;
            for (size_t k = 0; k < joints; ++k) {
                fastest = std::max(fastest, std::abs(tick.q[k] - before[k]));
            }
        }
        CHECK(worst == 0.0);
        CHECK(fastest <= 0.001 * (1.0 + 1e-12)); // 1 rad/s in 1 ms
        CHECK(limited > 100);
    }
}

TEST_CASE("No leaf of any link enters any of hundreds of spheres under a wild hand") {
    std::mt19937_64 random(11);
    for (size_t joints : {4u, 5u, 6u, 7u, 12u}) {
        if (kSanitized && joints != 6) {
            continue;
        }
        const ArmModel arm = makeArm(joints, 8);
        ArmProxy proxy(arm, Pose{}, {}, JointVector{});
        World world;
        scatter(world, arm, proxy.frames(), random, 600);
        double deepest = -1.0, worst = 0.0;
        size_t touching = 0, trapped = 0;
        Pose target;
        for (int i = 0; i < 2500; ++i) {
            if (i % 250 == 0) {
                target = {randomIn(random, 1.0), randomRotation(random)};
            }
            if (i % 3 == 0) {
                world.query(arm, proxy); // answers also come late
            }
            REQUIRE(proxy.accepts(world.set));
            const ArmStep tick = proxy.step(target, 0.05, &world.set);
            deepest = std::max(deepest, world.depth(arm, proxy.frames()));
            worst = std::max(worst, worstLimit(arm, tick.q));
            touching += tick.active.empty() ? 0 : 1;
            trapped += tick.trapped ? 1 : 0;
        }
        MESSAGE(joints << " joints: deepest " << 1e6 * deepest << " um, in contact " << touching
                       << " of 2500 ticks");
        CHECK(deepest <= 1e-9);
        CHECK(worst == 0.0);
        CHECK(touching > 200);
        CHECK(trapped == 0);
    }
}

TEST_CASE("A blocked elbow stops the tip although the tip itself is free") {
    const ArmModel arm = makeArm(4, 8);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{});
    World world;
    world.fixtures.spheres.add({0.12, 0.2, 0.0}, 0.05); // next to the first link
    world.grid.build(world.fixtures.spheres);
    const Pose target{{0.1, 0.95, 0.0}, kUpright};
    ArmStep tick;
    double deepest = -1.0;
    for (int i = 0; i < 4000; ++i) {
        world.query(arm, proxy);
        tick = proxy.step(target, 0.0, &world.set);
        deepest = std::max(deepest, world.depth(arm, proxy.frames()));
    }
    CHECK(deepest <= 1e-9);
    CHECK(!tick.active.empty());
    CHECK(world.depth(arm, proxy.frames()) > -1e-5); // it rests on the sphere
    CHECK(proxy.joints()[0] < 1.0);
}

TEST_CASE("New data over a link pushes it out by 1 mm per tick and never deeper") {
    const ArmModel arm = makeArm(4, 8);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{});
    World world;
    world.fixtures.spheres.add({0.6, 0.075, 0.0}, 0.05);
    world.grid.build(world.fixtures.spheres);
    double before = world.depth(arm, proxy.frames());
    REQUIRE(before > 0.01);
    const Pose still = proxy.tip();
    size_t trapped = 0;
    for (int i = 0; i < 200; ++i) {
        world.query(arm, proxy);
        const ArmStep tick = proxy.step(still, 0.0, &world.set);
        const double now = world.depth(arm, proxy.frames());
        CHECK(now <= std::max(before, 0.0) + 1e-12); // once outside, a gap below a nanometre is not a depth
        trapped += tick.trapped ? 1 : 0;
        before = now;
    }
    CHECK(trapped == 0);
    CHECK(before <= 1e-6);
}

TEST_CASE("A stretched arm is reported as singular, is damped, and comes back") {
    const ArmModel arm = makeArm(4, 2);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{0.1, 0.3, -0.4, 0.5});
    ArmFrames bent;
    arm.place({0.4, 0.5, -0.3, 0.6}, Pose{}, bent);
    ArmStep tick;
    size_t singular = 0;
    double largest = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const JointVector before = proxy.joints();
        tick = proxy.step({{5.0, 0.0, 0.0}, kUpright}, 0.0, nullptr);
        singular += tick.singular ? 1 : 0;
        if (i > 2900) {
            for (size_t k = 0; k < 4; ++k) {
                largest = std::max(largest, std::abs(tick.q[k] - before[k]));
            }
        }
    }
    CHECK(singular > 100);
    CHECK(largest < 1e-5); // at rest, no oscillation
    CHECK(tick.pose.position.x > 0.99);
    for (int i = 0; i < 3000; ++i) {
        tick = proxy.step(arm.tip(bent), 0.0, nullptr);
    }
    CHECK(tick.residual < 1e-4);
}

TEST_CASE("A target that is not finite holds the arm, and a start outside the limits is clamped") {
    const ArmModel arm = makeArm(4, 2, 0.5);
    ArmProxy proxy(arm, Pose{}, {}, JointVector{3.0, -3.0, std::numeric_limits<double>::quiet_NaN(), 0.1});
    CHECK(proxy.joints() == JointVector{0.5, -0.5, 0.0, 0.1});
    const ArmStep tick =
        proxy.step({dvec3(std::numeric_limits<double>::quiet_NaN()), kUpright}, 0.1, nullptr);
    CHECK(tick.q == proxy.joints());
    CHECK(proxy.joints() == JointVector{0.5, -0.5, 0.0, 0.1});
    ContactSet other; // of another tool
    CHECK_FALSE(proxy.accepts(other));
}

TEST_CASE("The smallest singular value and the damping match the textbook formulas") {
    ArmNormal normal(3);
    normal.addColumn(0, {3, 0, 0}, dvec3(0.0));
    normal.addColumn(1, {0, 0.5, 0}, dvec3(0.0));
    normal.addColumn(2, {0, 0, 0}, {0, 2, 0});
    CHECK(normal.smallestSingular() == doctest::Approx(0.5).epsilon(1e-12));
    normal.damp(0.0);
    JointVector x{};
    normal.solve({3.0, 1.0, 9.0}, {0.0, 4.0, 0.0}, x);
    CHECK(x[0] == doctest::Approx(1.0));
    CHECK(x[1] == doctest::Approx(2.0));
    CHECK(x[2] == doctest::Approx(2.0));
    CHECK(dampingFor(1.0, 0.1, 0.001, 0.05) == 0.001);
    CHECK(dampingFor(0.0, 0.1, 0.001, 0.05) == 0.05);
    CHECK(dampingFor(0.05, 0.1, 0.001, 0.05) == doctest::Approx(0.025));
}

TEST_CASE("A tick of a whole arm of up to 2000 leaves allocates nothing and enters no region") {
    std::mt19937_64 random(3);
    for (size_t leaves : {500u, 1000u, 2000u}) {
        const ArmModel arm = makeArm(5, leaves / 5);
        ArmProxy proxy(arm, Pose{}, {}, JointVector{});
        World world;
        scatter(world, arm, proxy.frames(), random, 3000);
        uint64_t allocated = 0;
        Pose target;
        for (int i = 0; i < 300; ++i) {
            if (i % 60 == 0) {
                target = {randomIn(random, 1.0), randomRotation(random)};
            }
            world.query(arm, proxy);
            const uint64_t held = allocationCount();
            proxy.step(target, 0.05, &world.set);
            allocated += allocationCount() - held;
        }
        CHECK(world.depth(arm, proxy.frames()) <= 1e-9);
        CHECK(allocated == 0);
    }
}
