// SPDX-License-Identifier: Apache-2.0
// The self-filter, which removes the arm: classify.comp against its float64 twin.
#include "engine/reference/self_filter.h"

#include "engine/cycle/arm_setup.h"
#include "engine/types/error.h"
#include "tests/support/cloud_rig.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

CloudRig filteredRig(uint32_t width, uint32_t height) {
    return CloudRig(plainScene(), pinholeCamera(width, height), [](Plan& plan) { plan.selfFilter = true; });
}

// A wall at 1 m and, in front of it, the near sides of these balls (camera frame).
Image wallAndBalls(const CameraInfo& camera, std::span<const Sphere> balls) {
    return drawnImage(camera, [&](int u, int v) {
        const dvec3 ray(camera.depth.ray(u, v), 1.0);
        double z = 1.0;
        for (const Sphere& ball : balls) {
            const double b = glm::dot(ray, ball.centre), a = glm::dot(ray, ray);
            const double inside =
                b * b - a * (glm::dot(ball.centre, ball.centre) - ball.radius * ball.radius);
            z = inside > 0.0 ? std::min(z, (b - std::sqrt(inside)) / a) : z;
        }
        return z;
    });
}

struct Agreement {
    uint32_t marked = 0, removed = 0, wrong = 0;
};

Agreement compare(const CloudRig& rig, std::span<const Sphere> spheres) {
    reference::ClassImage twin = reference::classify(rig.view(), nullptr);
    const std::vector<uint32_t> unfiltered = twin.masks;
    reference::removeArm(rig.view(), spheres, twin);
    const std::vector<uint32_t> masks = rig.masks();
    Agreement a;
    for (size_t i = 0; i < masks.size(); ++i) {
        a.marked += masks[i] != 0;
        a.removed += unfiltered[i] != 0 && masks[i] == 0;
        a.wrong += masks[i] != twin.masks[i] && twin.unsure[i] == 0;
    }
    return a;
}

cloud::ArmSpheres linksOf(std::vector<Sphere> spheres, std::vector<uint32_t> ends) {
    return {std::move(spheres), std::move(ends)};
}

} // namespace

TEST_CASE("Points of the arm, padding included, have no class, and all others keep theirs") {
    for (const auto& [width, height] : {std::pair{160u, 120u}, {61u, 47u}, {1u, 1u}}) {
        CloudRig rig = filteredRig(width, height);
        std::vector<Sphere> balls;
        for (int i = 0; i < 6; ++i) {
            balls.push_back({{-0.2 + 0.08 * i, 0.05 * (i % 2), 0.6}, 0.05});
        }
        std::vector<Sphere> arm = balls;
        for (Sphere& s : arm) {
            s.radius += 0.005;
        }
        rig.cycle().setArm(linksOf(arm, {2, 6}));
        rig.run(wallAndBalls(rig.camera(), balls));
        const Agreement a = compare(rig, arm);
        CHECK(a.wrong == 0);
        if (width > 1) {
            CHECK(a.removed > 100);
            CHECK(a.marked > 500);
            // The arm makes no region: all remaining points are on the wall.
            for (size_t i = 0; i < rig.host().spheres.size(); ++i) {
                CHECK(rig.host().spheres.z[i] + rig.origin().z > 0.9);
            }
        }
    }
}

TEST_CASE("An arm is removed from a frame whose camera is off by three sigma of its registration") {
    const testing::ScratchFile urdf(
        "arm.urdf", "<robot name='r'><link name='a'><collision><geometry><sphere radius='0.05'/>"
                    "</geometry></collision></link><link name='b'/><joint name='j' type='continuous'>"
                    "<parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint></robot>");
    const dvec3 middle(0.0, 0.0, 0.6), off = 0.99 * 3.0 * 0.01 * glm::normalize(dvec3(0.8, 0.5, -0.4));
    for (const double sigma : {0.0, 0.01}) {
        CloudRig rig = filteredRig(160, 120);
        Scene scene = plainScene();
        scene.registrationSigma = sigma;
        scene.arm.emplace();
        scene.arm->urdf = urdf.path();
        scene.arm->selfFilter = 0.002;
        scene.arm->baseTarm.position = middle;
        const auto arm = makeArmSetup(scene, {});
        rig.cycle().setArm(arm->inImage(arm->startPosture()));
        const std::vector<Sphere> seen{{middle + off, 0.05}};
        rig.run(wallAndBalls(rig.camera(), seen));
        size_t left = 0;
        for (size_t i = 0; i < rig.host().spheres.size(); ++i) {
            left += rig.host().spheres.z[i] + rig.origin().z < 0.9 ? 1 : 0;
        }
        CAPTURE(sigma);
        CHECK((left == 0) == (sigma > 0.0));
    }
}

TEST_CASE("Two thousand spheres on twenty links, at a pose far from the base origin, agree with the twin") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> spread(-0.4, 0.4), size(0.005, 0.04);
    const Pose pose{{1000.0, -500.0, 20.0}, rotationExp({0.3, -0.2, 0.1})};
    std::vector<Sphere> arm;
    std::vector<uint32_t> ends;
    for (int link = 0; link < 20; ++link) {
        const dvec3 middle(spread(random), spread(random), 1.0);
        for (int i = 0; i < 100; ++i) {
            const dvec3 off(spread(random), spread(random), spread(random));
            arm.push_back({pose.apply(middle + 0.2 * off), size(random)});
        }
        ends.push_back(static_cast<uint32_t>(arm.size()));
    }
    CloudRig rig = filteredRig(160, 120);
    rig.cycle().setArm(linksOf(arm, ends));
    rig.run(stressImage(rig.camera(), 3), -1.0, pose);
    const Agreement a = compare(rig, arm);
    MESSAGE(a.removed << " points of the arm taken out, " << a.marked << " left");
    CHECK(a.wrong == 0);
    CHECK(a.removed > 500);
    CHECK(a.marked > 500);
}

TEST_CASE("A moving arm is removed where each frame shows it, and an arm outside the view removes nothing") {
    CloudRig rig = filteredRig(64, 48);
    const Image wall = wallAndBalls(rig.camera(), {});
    rig.run(wall);
    const uint32_t all = compare(rig, {}).marked;
    CHECK(all == 64 * 48);
    for (int i = 0; i < 4; ++i) {
        const std::vector<Sphere> arm{{{-0.3 + 0.2 * i, 0.0, 1.0}, 0.1}};
        rig.cycle().setArm(linksOf(arm, {1}));
        rig.run(wall);
        const Agreement a = compare(rig, arm);
        CHECK(a.wrong == 0);
        CHECK(a.removed > 20);
    }
    rig.cycle().setArm({});
    rig.run(wall);
    CHECK(compare(rig, {}).marked == all);
    cloud::ArmSpheres many;
    many.spheres.resize(cloud::ArmSpheres::kMaxSpheres + 1, {dvec3(0.0), 1.0});
    many.ends = {static_cast<uint32_t>(many.spheres.size())};
    rig.cycle().setArm(many);
    CHECK_THROWS_AS(rig.run(wall), Error);
}
