// SPDX-License-Identifier: Apache-2.0
// Compares an arm's step with the formulas: what it minimises, its largest travel, and which joints count.
#include "engine/haptics/arm_proxy.h"
#include "engine/reference/nearest_point.h"
#include "tests/haptics/arm_proxy_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <numeric>
#include <vector>

using namespace fathom;
using namespace fathom::testing;

namespace {

using Columns = std::vector<std::array<double, 6>>;

double dot(std::span<const double> a, std::span<const double> b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::array<double, 6> stacked(const dvec3& upper, const dvec3& lower) {
    return {upper.x, upper.y, upper.z, lower.x, lower.y, lower.z};
}

// M^1/2 J of the tip for these joints.
Columns tipColumns(const ArmModel& arm, const ArmFrames& frames, double k,
                   const std::vector<size_t>& joints) {
    Columns columns;
    for (const size_t j : joints) {
        columns.push_back(
            stacked(arm.motionOf(frames, j, arm.tip(frames).position), k * arm.rotationOf(frames, j)));
    }
    return columns;
}

// J^T J + damping^2, row by row.
std::vector<double> squares(const Columns& columns, double damping) {
    std::vector<double> out;
    for (const auto& row : columns) {
        for (const auto& column : columns) {
            out.push_back(dot(row, column) + (&row == &column ? damping * damping : 0.0));
        }
    }
    return out;
}

// Solves a x = b. a is symmetric and positive definite, so no pivoting is needed.
std::vector<double> solve(std::vector<double> a, std::vector<double> b) {
    const size_t n = b.size();
    for (size_t p = 0; p < n; ++p) {
        for (size_t i = 0; i < n; ++i) {
            const double share = i == p ? 0.0 : a[i * n + p] / a[p * n + p];
            for (size_t j = p; j < n; ++j) {
                a[i * n + j] -= share * a[p * n + j];
            }
            b[i] -= share * b[p];
        }
    }
    for (size_t i = 0; i < n; ++i) {
        b[i] /= a[i * n + i];
    }
    return b;
}

// By inverse iteration from a start with a component in every direction.
double smallestSingularValue(const Columns& columns) {
    std::vector<double> direction;
    for (size_t i = 0; i < columns.size(); ++i) {
        direction.push_back(1.0 / static_cast<double>(i + 2));
    }
    const std::vector<double> matrix = squares(columns, 0.0);
    double length = 0.0;
    for (int step = 0; step < 200; ++step) {
        direction = solve(matrix, direction);
        length = std::sqrt(dot(direction, direction));
        for (double& d : direction) {
            d /= length;
        }
    }
    return 1.0 / std::sqrt(length);
}

std::vector<size_t> movingJoints(const ArmModel& arm) {
    std::vector<size_t> moving;
    for (size_t k = 0; k < arm.count(); ++k) {
        if (arm.joints[k].lower < arm.joints[k].upper) {
            moving.push_back(k);
        }
    }
    return moving;
}

// The increments that minimise |J dq - x|_M^2 + lambda^2 |dq|^2 subject to one row n^T J_leaf dq >= -gap.
std::vector<double> nearestIncrements(const ArmModel& arm, const ArmFrames& frames, double k, const dvec3& a,
                                      const dvec3& alpha, size_t leaf, const dvec3& normal, double gap) {
    const size_t n = arm.count();
    const Columns columns = tipColumns(arm, frames, k, movingJoints(arm));
    const std::vector<double> metric = squares(columns, ArmProxyOptions{}.damping);
    std::vector<double> pull;
    for (const auto& column : columns) {
        pull.push_back(dot(column, stacked(a, k * alpha)));
    }
    const std::vector<double> free = solve(metric, pull);
    std::vector<double> row(n, 0.0);
    for (size_t j = 0; j < arm.leaves[leaf].joint; ++j) {
        row[j] = glm::dot(normal, arm.motionOf(frames, j, arm.centre(frames, leaf)));
    }
    const std::array<double, 1> offset{-gap};
    const auto nearest = nearestPoint({n, metric, free, row, offset});
    REQUIRE(nearest.feasible);
    REQUIRE(nearest.multipliers[0] > 0.0); // the row is active
    return nearest.x;
}

} // namespace

TEST_CASE(
    "A step against a region is the nearest one in the arm's metric with the given weight of rotation") {
    ArmModel arm = makeArm(4, 1);
    for (ArmJoint& joint : arm.joints) {
        joint.speed = 50.0; // does not limit this step
    }
    const JointVector start{0.2, 0.5, -0.4, 0.6};
    ArmFrames frames;
    arm.place(start, Pose{}, frames);
    const dvec3 towards = glm::normalize(dvec3(0.3, 0.8, 0.4));
    World world;
    world.fixtures.spheres.add(arm.centre(frames, 3) + (0.04 + 0.03 + 0.0001) * towards, 0.03);
    world.grid.build(world.fixtures.spheres);
    const RegionSpheres& s = world.fixtures.spheres;
    const dvec3 between = arm.centre(frames, 3) - world.fixtures.origin - dvec3(s.x[0], s.y[0], s.z[0]);
    const double gap = glm::length(between) - 0.04 - static_cast<double>(s.radius[0]);
    const dvec3 shift = 4e-4 * towards, tick{2e-4, -3e-4, 4e-4};
    std::vector<double> other;
    for (const double k : {0.05, 0.5}) {
        CAPTURE(k);
        ArmProxyOptions options;
        options.solves = 1;
        ArmProxy proxy(arm, Pose{}, options, start);
        world.query(arm, proxy);
        const Pose tip = proxy.tip();
        const Pose target{tip.position + shift, rotationExp(tick) * tip.rotation};
        const ArmStep out = proxy.step(target, k, &world.set);
        REQUIRE(out.active.size() == 1);
        CHECK_FALSE(out.singular);
        const auto truth = nearestIncrements(arm, frames, k, shift, tick, 3, glm::normalize(between), gap);
        double apart = 0.0;
        for (size_t j = 0; j < 4; ++j) {
            CHECK(out.q[j] - start[j] == doctest::Approx(truth[j]).epsilon(2e-3).scale(1e-4));
            apart = std::max(apart, other.empty() ? 0.0 : std::abs(other[j] - truth[j]));
        }
        CHECK((other.empty() || apart > 1e-5)); // another metric gives another step
        other = truth;
    }
}

TEST_CASE("No leaf of a fast arm exceeds the step caps of a tick or enters a region") {
    std::mt19937_64 random(17);
    ArmModel arm = makeArm(4, 8);
    for (ArmJoint& joint : arm.joints) {
        joint.speed = 50.0; // 50 mm per tick at the end of the arm; regions have 30 mm radius
    }
    const ArmProxyOptions options;
    ArmProxy proxy(arm, Pose{}, options, JointVector{});
    World world;
    scatter(world, arm, proxy.frames(), random, 400);
    double farthest = 0.0, deepest = -1.0;
    Pose target;
    for (int i = 0; i < 1500; ++i) {
        if (i % 100 == 0) {
            target = {randomIn(random, 1.0), randomRotation(random)};
        }
        world.query(arm, proxy);
        const ArmFrames before = proxy.frames();
        proxy.step(target, 0.05, &world.set);
        for (size_t l = 0; l < arm.leaves.size(); ++l) {
            farthest =
                std::max(farthest, glm::distance(arm.centre(before, l), arm.centre(proxy.frames(), l)));
        }
        deepest = std::max(deepest, world.depth(arm, proxy.frames()));
    }
    MESSAGE("farthest " << farthest * 1e3 << " mm per tick, deepest " << deepest * 1e6 << " um");
    CHECK(farthest <= options.solves * options.stepCap * (1.0 + 1e-9));
    CHECK(farthest > options.stepCap); // the arm was fast
    CHECK(deepest <= 1e-9);
}

TEST_CASE("Arms with six and seven joints reach a reachable position and direction of the tip") {
    for (size_t joints : {6u, 7u}) {
        ArmModel arm = makeArm(joints, 1);
        arm.joints[3].axis = {1, 0, 0}; // a roll joint in the middle, as real arms have
        ArmProxy proxy(arm, Pose{}, {}, JointVector{0.2, 0.3, -0.2, 0.4, 0.1, -0.3, 0.2});
        ArmFrames there;
        arm.place(JointVector{-0.1, 0.6, 0.1, 0.6, 0.4, -0.5, 0.1}, Pose{}, there);
        ArmStep tick;
        for (int i = 0; i < 6000; ++i) {
            tick = proxy.step(arm.tip(there), 0.1, nullptr);
        }
        CAPTURE(joints);
        CHECK(tick.residual < 1e-6);
        const dquat apart = glm::conjugate(arm.tip(there).rotation) * tick.pose.rotation;
        CHECK(2.0 * glm::length(dvec3(apart.x, apart.y, apart.z)) < 1e-5);
        CHECK(glm::distance(tick.pose.position, arm.tip(there).position) < 1e-6);
    }
}

TEST_CASE("Locked joints are excluded from an arm's singular values, also in a real arm's URDF") {
    std::vector<ArmModel> arms;
    arms.push_back(makeArm(4, 1));
    arms.push_back(makeArm(7, 1));
    for (ArmModel& arm : arms) {
        arm.joints[1].lower = arm.joints[1].upper = 0.3;
    }
    if (const std::filesystem::path file = "../shared/data/urdf/oberon4/oberon4.urdf";
        std::filesystem::exists(file)) {
        ArmOptions few;
        few.leavesPerShape = 2;
        arms.push_back(loadArm(file, few));
        CHECK(movingJoints(arms.back()).size() < arms.back().count()); // its anchor is locked
    } else {
        MESSAGE("SKIPPED: no such file: " << file);
    }
    for (const ArmModel& arm : arms) {
        CAPTURE(arm.count());
        ArmProxy proxy(arm, Pose{}, {}, JointVector{0.2, 0.3, 0.4, -0.5, 0.3, -0.2, 0.1});
        const std::vector<size_t> moving = movingJoints(arm);
        const Columns columns = tipColumns(arm, proxy.frames(), 0.1, moving);
        const double truth = smallestSingularValue(columns);
        Pose target = proxy.tip();
        target.position += dvec3(0.001, 0.002, -0.001);
        const JointVector before = proxy.joints();
        const ArmStep tick = proxy.step(target, 0.1, nullptr);
        CHECK(tick.smallestSingularValue == doctest::Approx(truth).epsilon(1e-6));
        CHECK(tick.smallestSingularValue > 1e-4);
        for (size_t k = 0; k < arm.count(); ++k) {
            const bool locked = std::find(moving.begin(), moving.end(), k) == moving.end();
            CHECK((!locked || tick.q[k] == before[k]));
        }
        CHECK(tick.residual < 0.0024); // it moved
    }
}
