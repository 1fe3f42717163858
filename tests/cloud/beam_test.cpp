// SPDX-License-Identifier: Apache-2.0
// Sensors that measure along beams, against the float64 twins: points of a fan, range gates, and spheres that
// grow by their own sigma, seen and held. The plan of a camera contains none of these.
#include "engine/reference/hold.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// 70 degrees wide, principal point off the middle.
CameraInfo fanCamera(uint32_t width, uint32_t height) {
    CameraInfo camera = pinholeCamera(width, height);
    camera.depth.fan = true;
    camera.depth.fx = camera.depth.fy = width / 1.2;
    camera.colour = camera.depth;
    camera.beam = BeamSigma{0.003, 0.002, 0.02};
    return camera;
}

struct Worst {
    double point = 0.0, radius = 0.0; // [m]
    uint32_t spheres = 0, wrong = 0;
};

void compare(const CloudRig& rig, Worst& worst) {
    const reference::FrameView view = rig.view();
    const auto points = rig.points();
    const auto twin =
        reference::spheres(rig.scene(), rig.forbidden(), points, reference::beamGrowth(view, points));
    const auto spheres = rig.spheres();
    for (int v = 0; v < rig.height(); ++v) {
        for (int u = 0; u < rig.width(); ++u) {
            const size_t i = view.index(u, v);
            worst.wrong += (spheres[i].radius >= 0.0) != (twin[i].radius >= 0.0);
            if (spheres[i].radius < 0.0 || twin[i].radius < 0.0) {
                continue;
            }
            ++worst.spheres;
            const dvec3 truth = view.baseTcamera().apply(view.point(u, v, view.z(u, v)));
            worst.point = std::max(worst.point, glm::distance(spheres[i].centre, truth));
            worst.radius = std::max(worst.radius, std::abs(spheres[i].radius - twin[i].radius));
        }
    }
}

} // namespace

TEST_CASE("A fan's points are on its beams, and each sphere grows by three sigma at its own range") {
    Worst worst;
    for (const bool byPixel : {false, true}) {
        for (const auto& [width, height] : {std::pair(1u, 1u), {33u, 17u}, {64u, 48u}, {129u, 50u}}) {
            Scene scene = plainScene();
            scene.errorBudget = 0.001; // beams exclude thinning nevertheless
            scene.baseTcamera = {{0.3, -0.2, 0.1}, rotationExp({0.2, 0.1, -0.3})};
            CloudRig rig(scene, fanCamera(width, height), [&](Plan& plan) {
                plan.byPixel = byPixel;
                plan.pack = plan.pack && byPixel;
            });
            CHECK_FALSE(rig.plan().thin);
            rig.run(stressImage(rig.camera(), width));
            compare(rig, worst);
        }
    }
    CHECK(worst.wrong == 0);
    CHECK(worst.spheres > 5000);
    CHECK(worst.point < 5e-6);
    CHECK(worst.radius < 1e-6);
    MESSAGE("beams: largest error of a point ", worst.point * 1e6, " um, of a radius ", worst.radius * 1e6,
            " um over ", worst.spheres);
}

TEST_CASE("A range gate accepts points between two spheres about the sensor, inclusive, combined with other "
          "gates") {
    Scene scene = plainScene();
    scene.fixtures[0].range = Band{0.8, 1.1};
    scene.fixtures.push_back(guidanceClass("far"));
    scene.fixtures[1].range = Band{1.0, 9.0};
    scene.fixtures[1].hue = Band{300, 60};
    scene.fixtures.push_back(forbiddenClass("all", 0.02));
    for (const CameraInfo& camera : {fanCamera(65, 33), pinholeCamera(65, 33)}) {
        CloudRig rig(scene, camera);
        CHECK(rig.plan().range);
        rig.run(stressImage(camera, 7));
        const auto twin = reference::classify(rig.view(), nullptr);
        const auto masks = rig.masks();
        uint32_t wrong = 0, inside = 0, outside = 0;
        for (size_t i = 0; i < masks.size(); ++i) {
            wrong += masks[i] != twin.masks[i] && twin.unsure[i] == 0;
            inside += (masks[i] & 1u) != 0;
            outside += masks[i] == 4u;
        }
        CHECK(wrong == 0);
        CHECK(inside > 50);
        CHECK(outside > 50);
    }
    // A point exactly on a bound: 0.8 m straight ahead.
    CameraInfo one = fanCamera(1, 1);
    one.depth.cx = one.depth.cy = 0.0;
    CloudRig rig(scene, one);
    rig.run(drawnImage(one, [](int, int) { return 0.8; }));
    CHECK((rig.masks()[0] & 1u) == 1);
}

namespace {

// Largest difference of a held sphere's radius from the float64 twin's; no sphere is smaller than that.
double heldDifference(const CameraInfo& camera) {
    Scene scene = plainScene();
    scene.holdSeconds = 0.2;
    CloudRig rig(scene, camera);
    REQUIRE(rig.plan().beam);
    reference::HoldMemory memory;
    uint32_t held = 0, wrong = 0;
    double worst = 0.0, before = 0.0;
    for (int k = 0; k < 8; ++k) {
        const Pose pose{{0.02 * k, 0.0, -0.05 * k}, rotationExp({0.0, 0.03 * k, 0.0})};
        const auto image = drawnImage(
            camera, [k](int u, int v) { return (u + 3 * k) % 9 < 4 && v > 3 ? 0.0 : 0.9 + 0.01 * v; });
        rig.run(image, k / 30.0, pose);
        const auto twin = memory.step(rig.view(), k / 30.0, before, rig.forbidden(), rig.points());
        before = k / 30.0;
        const auto here = rig.spheres(true);
        for (size_t i = 0; i < here.size(); ++i) {
            const bool both = here[i].radius >= 0.0 && twin[i].radius >= 0.0;
            wrong += (here[i].radius >= 0.0) != (twin[i].radius >= 0.0) && memory.unsure()[i] == 0;
            held += both;
            if (both && memory.unsure()[i] == 0) {
                wrong += here[i].radius < twin[i].radius - 1e-6; // rounded up, never down
                worst = std::max(worst, std::abs(here[i].radius - twin[i].radius));
            }
        }
    }
    CHECK(wrong == 0);
    CHECK(held > 500);
    MESSAGE(held, " held points, largest difference of a radius ", worst * 1e6, " um");
    return worst;
}

} // namespace

TEST_CASE("A held point of a moving fan keeps the sphere size from when it was last seen") {
    CameraInfo camera = fanCamera(40, 24);
    CHECK(heldDifference(camera) < 1.1e-5);
    camera.beam->range = 1.0; // three of these exceed 2.6 m
    CHECK(heldDifference(camera) < 5.2e-3);
}

TEST_CASE("A camera's plan has no beam features, and a fan's plan has only those that it needs") {
    Scene scene = plainScene();
    scene.errorBudget = 0.0001;
    const DeviceFacts facts = vulkan().device.facts();
    const Plan plain = makePlan(scene, pinholeCamera(64, 48), 1, facts);
    CHECK_FALSE(plain.fan);
    CHECK_FALSE(plain.beam);
    CHECK_FALSE(plain.range);
    CHECK_FALSE(plain.rays);
    CHECK(plain.thin);
    CameraInfo camera = fanCamera(64, 48);
    const Plan fan = makePlan(scene, camera, 1, facts);
    CHECK(fan.fan);
    CHECK(fan.beam);
    CHECK(fan.rays);
    CHECK_FALSE(fan.thin);
    camera.beam.reset();
    CHECK_FALSE(makePlan(scene, camera, 1, facts).beam);
    scene.fixtures = {guidanceClass("guide")};
    CHECK_FALSE(makePlan(scene, fanCamera(64, 48), 1, facts).beam); // no spheres, so nothing grows
}
