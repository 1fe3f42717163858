// SPDX-License-Identifier: Apache-2.0
// Guidance poses from points: planes at several angles through all passes, and poses compared with the twin.
#include "engine/cloud/guidance_pose.h"
#include "engine/reference/guidance.h"
#include "engine/types/angle.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

const dvec3 kX(1, 0, 0), kZ(0, 0, 1);

FixtureClass goal() {
    FixtureClass f = guidanceClass("goal");
    f.orientation = rotationExp({0.3, -0.2, 0.5});
    f.standoff = 0.05;
    return f;
}

double angleBetween(const dvec3& a, const dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) / kDegree;
}

struct PoseError {
    double position = 0.0, normal = 0.0, target = 0.0, rotation = 0.0; // [m], [rad], [m], [rad]
};

PoseError compare(const GuidancePose& here, const GuidancePose& there) {
    CHECK(here.count == there.count);
    CHECK(here.present == there.present);
    CHECK(here.planar == there.planar);
    CHECK(here.rollFree == there.rollFree);
    return {glm::distance(here.position, there.position), glm::distance(here.normal, there.normal),
            glm::distance(here.target.position, there.target.position),
            glm::length(rotationBetween(there.target.rotation, here.target.rotation))};
}

std::vector<dvec3> slab(std::mt19937_64& random, const dvec3& centre, const dquat& turn, const dvec3& sigma,
                        int count) {
    std::normal_distribution<double> normal;
    std::vector<dvec3> points;
    for (int i = 0; i < count; ++i) {
        points.push_back(centre + turn * (sigma * dvec3(normal(random), normal(random), normal(random))));
    }
    return points;
}

GuidancePose poseOf(const std::vector<dvec3>& points, const FixtureClass& f, const dvec3& camera) {
    return cloud::guidancePose(cloud::momentsOf(points), f, 0, camera);
}

Scene goalScene(const FixtureClass& f) {
    Scene scene = plainScene();
    scene.fixtures = {f};
    return scene;
}

} // namespace

TEST_CASE("A plane seen at any angle gives its normal towards the camera, and the target stands off along it "
          "with +z facing it") {
    const CameraInfo camera = pinholeCamera(160, 120, 0.0001);
    const Pose pose{{0.4, -0.3, 1.1}, rotationExp({0.5, -0.7, 0.2})};
    double worst = 0.0;
    for (const double tilt : {0.0, 15.0, 30.0, 45.0, 60.0, 70.0}) {
        for (const double about : {0.0, 77.0, 200.0}) {
            CAPTURE(tilt);
            CAPTURE(about);
            const dvec3 normal(std::sin(tilt * kDegree) * std::cos(about * kDegree),
                               std::sin(tilt * kDegree) * std::sin(about * kDegree),
                               -std::cos(tilt * kDegree));
            Scene scene = goalScene(goal());
            scene.baseTcamera = pose;
            CloudRig rig(scene, camera);
            rig.run(drawnImage(camera, [&](int u, int v) {
                return u > 50 && u < 110 && v > 40 && v < 80
                           ? planeDepth(camera, u, v, normal, 0.6 * normal.z)
                           : 0.0;
            }));
            const GuidancePose& g = rig.host().guidance[0];
            CHECK(g.planar);
            const double off = angleBetween(g.normal, pose.rotation * normal);
            worst = std::max(worst, off);
            CHECK(off < 0.05);
            CHECK(glm::distance(g.target.position, g.position + 0.05 * g.normal) < 1e-12);
            CHECK(angleBetween(g.target.rotation * kZ, -g.normal) < 1e-5);
            const dvec3 centre = glm::conjugate(pose.rotation) * (g.position - pose.position);
            CHECK(std::abs(glm::dot(centre, normal) - 0.6 * normal.z) <
                  2e-5); // on the plane; depth units are 0.1 mm
        }
    }
    MESSAGE("largest angle between a plane's normal and the one found ", worst,
            " degrees (depth in units of 0.1 mm)");
}

TEST_CASE("The long axis gives the roll, and a square leaves it to the scene") {
    const CameraInfo camera = pinholeCamera(160, 120, 0.0001);
    for (const double angle : {0.0, 25.0, -60.0}) {
        CAPTURE(angle);
        FixtureClass f = goal();
        f.orientation = dquat(1, 0, 0, 0);
        CloudRig rig(goalScene(f), camera);
        const dvec3 along(std::cos(angle * kDegree), std::sin(angle * kDegree), 0.0);
        const auto bar = [&](int u, int v) {
            const glm::dvec2 p = camera.depth.ray(u, v) * 0.5;
            return std::abs(p.x * along.x + p.y * along.y) < 0.1 &&
                           std::abs(p.y * along.x - p.x * along.y) < 0.04
                       ? 0.5
                       : 0.0;
        };
        rig.run(drawnImage(camera, bar));
        CHECK_FALSE(rig.host().guidance[0].rollFree);
        CHECK(angleBetween(rig.host().guidance[0].target.rotation * kX, along) < 0.3);
        CloudRig round(goalScene(f), camera); // the first one's target settles over many frames
        round.run(drawnImage(
            camera, [&](int u, int v) { return glm::length(camera.depth.ray(u, v)) < 0.15 ? 0.5 : 0.0; }));
        CHECK(round.host().guidance[0].rollFree);
        CHECK(angleBetween(round.host().guidance[0].target.rotation * kX, kX) < 0.3);
    }
}

TEST_CASE("The pose equals the twin's for slabs, balls, rods and lines anywhere, also 100 km away") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    PoseError worst;
    uint32_t planar = 0, rollFree = 0;
    for (int i = 0; i < 400; ++i) {
        const dvec3 shapes[] = {{0.1, 0.05, 0.0005},  {0.05, 0.05, 0.05},     {0.1, 0.003, 0.003},
                                {0.04, 0.039, 0.002}, {0.006, 0.0055, 0.002}, {0.2, 0.1, 0.015}};
        const double away = i % 5 == 0 ? 1e5 : 1.0;
        const dvec3 centre = away * dvec3(unit(random), unit(random), 2.0);
        const auto points =
            slab(random, centre, rotationExp(3.0 * dvec3(unit(random), unit(random), unit(random))),
                 shapes[i % 6], 500);
        const dvec3 camera = centre + dvec3(unit(random), unit(random), -1.0);
        const GuidancePose here = poseOf(points, goal(), camera),
                           there = reference::guidance(points, goal(), camera);
        const PoseError e = compare(here, there);
        worst = {std::max(worst.position, e.position / away), std::max(worst.normal, e.normal),
                 std::max(worst.target, e.target / away), std::max(worst.rotation, e.rotation)};
        planar += here.planar, rollFree += here.planar && here.rollFree;
        if (!here.planar) {
            CHECK(here.target.rotation == goal().orientation);
            CHECK(angleBetween(here.target.position - here.position, camera - here.position) < 1e-5);
            CHECK(here.normal == dvec3(0.0));
        }
    }
    CHECK(planar > 100);
    CHECK(planar < 300);
    CHECK(rollFree > 50);
    CHECK(worst.position < 1e-12);
    CHECK(worst.normal < 1e-6);
    CHECK(worst.target < 1e-6);
    CHECK(worst.rotation < 1e-6);
    MESSAGE("pose: mean ", worst.position, " m, normal ", worst.normal, " rad, target ", worst.target,
            " m, rotation ", worst.rotation, " rad");
}

TEST_CASE("The plane test has thresholds of 3 mm thickness, a tenth of the width and 5 mm width") {
    // The eight corners of a box have exactly these standard deviations along its axes.
    const auto pose = [](double a, double b, double c) {
        std::vector<dvec3> points;
        for (int k = 0; k < 8; ++k) {
            points.emplace_back((k & 1 ? a : -a), (k & 2 ? b : -b), 1.0 + (k & 4 ? c : -c));
        }
        const GuidancePose g = poseOf(points, goal(), dvec3(0.0));
        compare(g, reference::guidance(points, goal(), dvec3(0.0)));
        return g;
    };
    CHECK(pose(0.02, 0.01, 0.00299).planar);
    CHECK_FALSE(pose(0.02, 0.01, 0.00301).planar);
    CHECK(pose(0.2, 0.1, 0.0099).planar);
    CHECK_FALSE(pose(0.2, 0.1, 0.0101).planar);
    CHECK(pose(0.02, 0.00501, 0.001).planar);
    CHECK_FALSE(pose(0.02, 0.00499, 0.001).planar);
    CHECK(pose(0.0141, 0.01, 0.001).rollFree); // l1 < 2 l2
    CHECK_FALSE(pose(0.0142, 0.01, 0.001).rollFree);
}

TEST_CASE(
    "Collinear points, two points, a single point and none have no plane and keep the scene's orientation") {
    const dvec3 camera(0.1, 0.2, -0.5);
    std::vector<dvec3> line;
    for (int i = 0; i < 100; ++i) {
        line.emplace_back(0.01 * i, 0.005 * i, 1.0 + 0.002 * i);
    }
    for (const size_t count : {size_t{100}, size_t{2}, size_t{1}}) {
        CAPTURE(count);
        const std::vector<dvec3> points(line.begin(), line.begin() + static_cast<long>(count));
        const GuidancePose g = poseOf(points, goal(), camera);
        compare(g, reference::guidance(points, goal(), camera));
        CHECK(g.present);
        CHECK_FALSE(g.planar);
        CHECK(g.target.rotation == goal().orientation);
        CHECK(glm::distance(g.position, g.target.position) == doctest::Approx(0.05));
    }
    const GuidancePose none = poseOf({}, goal(), camera);
    CHECK(none.count == 0);
    CHECK_FALSE(none.present);
    CHECK(isFinite(none.target));
    CHECK_FALSE(poseOf(
                    {line[0]},
                    [] {
                        FixtureClass f = goal();
                        f.minCount = 2;
                        return f;
                    }(),
                    camera)
                    .present);
    CHECK(isFinite(poseOf({camera}, goal(), camera).target)); // a point at the camera's position
}

TEST_CASE("Eigenvectors of symmetric matrices: residual, order and right angles, near-equal and zero roots "
          "included") {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
        std::array<double, 6> m{};
        for (double& x : m) {
            x = unit(random) * std::pow(10.0, i % 9 - 6);
        }
        if (i % 4 == 0) {
            m = {1.0, 1e-9 * m[1], 0.0, 1.0, 0.0, i % 8 == 0 ? 1.0 : 0.0};
        }
        const cloud::Eigen3 e = cloud::symmetricEigen(m);
        double scale = 1e-300;
        for (const double x : m) {
            scale = std::max(scale, std::abs(x));
        }
        CHECK(e.values.x >= e.values.y);
        CHECK(e.values.y >= e.values.z);
        for (int k = 0; k < 3; ++k) {
            const dvec3 v = e.vectors[static_cast<size_t>(k)];
            const dvec3 mv(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
                           m[2] * v.x + m[4] * v.y + m[5] * v.z);
            worst =
                std::max({worst, glm::length(mv - e.values[k] * v) / scale, std::abs(glm::length(v) - 1.0),
                          std::abs(glm::dot(v, e.vectors[static_cast<size_t>((k + 1) % 3)]))});
        }
    }
    CHECK(worst < 1e-14 * 10);
    MESSAGE("largest residual ", worst);
}
