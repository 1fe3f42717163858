// SPDX-License-Identifier: Apache-2.0
// Spheres that cross the bus as depths and growth steps: the host computes exactly the device's spheres.
#include "tests/cloud/pack_check.h"

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("From depths and growth steps the host computes exactly the device's spheres for lenses, fans, "
          "poses, classes, thinned and held points") {
    uint32_t grown = 0, held = 0, distorted = 0;
    bool holds = false;
    for (CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        holds = !holds;
        c.scene.holdSeconds = holds ? 1.0 : 0.0;
        CloudRig rig(c.scene, c.camera, packing(true));
        if (!rig.plan().spheres) {
            continue;
        }
        for (int frame = 0; frame < 2; ++frame) {
            const Pose pose{{0.1 * frame, 0.02, -0.3}, rotationExp({0.1, 0.2 * frame, -0.1})};
            rig.run(frame == 0 ? c.image : stressImage(c.camera, 7), -1.0, pose);
            checkPacked(rig);
            const RegionSpheres& s = rig.host().spheres;
            for (size_t i = 0; i < s.size(); ++i) {
                const FixtureClass& f = c.scene.fixtures[s.fixture[i]];
                const bool seen = s.source[i] < c.camera.depth.pixels();
                grown += seen && s.radius[i] > f.radius + 3.0 * c.scene.registrationSigma + 1e-6;
                held += !seen;
                distorted += seen && rig.plan().rays;
            }
        }
    }
    CHECK(grown > 100);
    CHECK(held > 100);
    CHECK(distorted > 100);
}

TEST_CASE("A frame in flight keeps the radii and the pose that its passes read") {
    const CameraInfo camera = pinholeCamera(50, 34);
    for (const bool pack : {false, true}) {
        CAPTURE(pack);
        CloudRig rig(plainScene(), camera, packing(pack));
        FrameCycle& cycle = rig.cycle();
        const Image image = drawnImage(camera, [](int, int) { return 0.8; });
        const auto frame = [&](uint32_t index) {
            Frame::Content content;
            content.index = index, content.sourceNumber = index, content.captureTime = index / 30.0;
            content.depth = image.depth, content.colour = image.colour;
            content.baseTcamera = Pose{{0.1 * index, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
            return Frame(content, nullptr);
        };
        cycle.upload(frame(1));
        cycle.submit();
        Scene wider = rig.scene();
        wider.fixtures[0].radius = 0.09;
        cycle.setScene(wider);
        const auto spheresOf = [&] {
            cycle.finish();
            const RegionSpheres& s = cycle.sets().newest()->host.spheres;
            REQUIRE(s.size() == 50 * 34);
            return std::pair(s.x[0], s.radius[0]);
        };
        const auto first = spheresOf();
        cycle.upload(frame(2));
        cycle.submit();
        const auto second = spheresOf();
        CHECK(first.second == 0.04f);
        CHECK(second.second == 0.09f);
        CHECK(second.first - first.first == doctest::Approx(0.1).epsilon(1e-5));
    }
}

TEST_CASE(
    "Grown spheres are packed in 24 bits per depth, or 32 bits in patches with a larger range of depths") {
    CameraInfo camera = pinholeCamera(61, 49, 0.0001);
    camera.depth.fx = camera.depth.fy = 600.0; // pixel spacing is smaller than the region radius
    camera.colour = camera.depth;
    Scene scene = plainScene();
    scene.errorBudget = 0.0005;
    scene.holdSeconds = 1.0;
    CloudRig rig(scene, camera, packing(true));
    // A depth step in the second patch of each row: slightly farther, by less than half, by much, and nearer.
    for (const double behind : {0.61, 0.85, 1.3, 2.5, 0.29}) {
        CAPTURE(behind);
        const Image step =
            drawnImage(camera, [&](int u, int v) { return u < 24 ? 0.6 + 0.0001 * v : behind; });
        rig.run(step);
        checkPacked(rig);
        const auto runs = rig.set().device.runs.as<glm::uvec2>();
        const uint32_t grown = runs[1].y & shared::kRunGrown, wide = runs[1].y & shared::kRunWide;
        CHECK(grown != 0);
        CHECK((wide != 0) == (behind > 1.2 || behind < 0.3));
        CHECK((runs[0].y & shared::kRunWide) == 0);
    }
    CHECK(std::ranges::any_of(rig.host().spheres.source, [](uint32_t s) { return s >= 61 * 49; }));
}
