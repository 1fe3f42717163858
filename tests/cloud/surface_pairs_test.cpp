// SPDX-License-Identifier: Apache-2.0
// surface.comp with two adjacent pixels per invocation.
#include "tests/cloud/surface_agreement.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Two pixels per invocation give the points of one, also in patches with one pixel of a pair") {
    for (const double edge : {0.0, 0.03}) {
        for (const uint32_t width : {67u, 68u, 1u}) {
            CAPTURE(edge);
            CAPTURE(width);
            const CameraInfo camera = pinholeCamera(width, 41);
            Scene scene = edgeScene(edge);
            scene.filter.radius = 2;
            scene.fixtures[0].hue = Band{20, 200}; // some pixels have no class
            const Image image = stressImage(camera, width);
            CloudRig one(scene, camera, [](Plan& plan) { plan.tiled = true, plan.filterBlock = false; });
            CloudRig two(scene, camera,
                         [](Plan& plan) { plan.tiled = plan.manyPatches = true, plan.filterBlock = false; });
            CHECK_FALSE(one.plan().filterPairs());
            CHECK(two.plan().filterPairs());
            one.run(image), two.run(image);
            CHECK((!onCpu() || (one.points().z == two.points().z && one.points().at == two.points().at)));
            const SurfaceAgreement agreement = comparePoints(two);
            CHECK((width == 1 || agreement.points > 300));
            CHECK((width == 1 || agreement.points < 67 * 30));
            CHECK(agreement.wrong == 0);
            CHECK(agreement.worst < 1e-6);
        }
    }
}

TEST_CASE("Two pixels per invocation are planned for large frames on GPUs with the 5x5 filter") {
    Scene scene = edgeScene(0.03);
    scene.filter.radius = 2;
    const auto planOf = [&](uint32_t width, uint32_t height, DeviceKind kind) {
        DeviceFacts facts = vulkan().device.facts();
        facts.kind = kind;
        return makePlan(scene, pinholeCamera(width, height), 1, facts);
    };
    CHECK(planOf(1920, 1080, DeviceKind::Discrete).filterPairs());
    CHECK_FALSE(planOf(1280, 720, DeviceKind::Discrete).manyPatches);
    CHECK_FALSE(planOf(3840, 2160, DeviceKind::Cpu).manyPatches);
    scene.filter.radius = 3;
    CHECK(planOf(1920, 1080, DeviceKind::Discrete).manyPatches);
    CHECK_FALSE(planOf(1920, 1080, DeviceKind::Discrete).filterPairs());
}
