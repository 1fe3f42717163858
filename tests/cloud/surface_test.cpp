// SPDX-License-Identifier: Apache-2.0
// Compares surface.comp with its float64 twin: rejection, filter, base-frame points.
#include "tests/cloud/surface_agreement.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

bool keeps(const CloudRig& rig, int u, int v) {
    return rig.points().z[static_cast<size_t>(v * rig.width() + u)] != 0.0;
}

} // namespace

TEST_CASE("Surface points are within 1 um of the twin's at 1 m and the same pixels are rejected, for every "
          "size and option") {
    SurfaceAgreement all;
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        CloudRig rig(c.scene, c.camera);
        rig.run(c.image);
        const SurfaceAgreement a = comparePoints(rig);
        CHECK(a.wrong == 0);
        CHECK(a.worst < 1e-6);
        all.points += a.points, all.rejected += a.rejected, all.unsure += a.unsure,
            all.worst = std::max(all.worst, a.worst);
    }
    CHECK(all.points > (kSanitized ? 50000 : 300000));
    CHECK(all.rejected > (kSanitized ? 500 : 3000));
    MESSAGE("surface: largest error ", all.worst * 1e6, " um a metre of range over ", all.points, " points; ",
            all.rejected, " pixels rejected, ", all.unsure, " on a threshold");
}

TEST_CASE("Windows from shared memory, direct reads, and blocks in registers give the same points") {
    for (const uint32_t radius : {0u, 1u, 2u, 5u, 16u}) {
        for (const double edge : {0.0, 0.03}) {
            if (kSanitized && edge == 0.0) {
                continue;
            }
            CAPTURE(radius);
            CAPTURE(edge);
            const CameraInfo camera = radius % 2 == 0 ? pinholeCamera(edge > 0.0 ? 67 : 68, 41)
                                                      : freiburgCamera(edge > 0.0 ? 68 : 67, 41);
            Scene scene = edgeScene(edge);
            scene.filter.radius = radius;
            scene.filter.isolated = edge > 0.0 || radius == 5;
            const Image image = stressImage(camera, radius + 20);
            CloudRig direct(scene, camera, [](Plan& plan) { plan.tiled = plan.filterBlock = false; });
            CloudRig tiled(scene, camera, [](Plan& plan) { plan.tiled = true, plan.filterBlock = false; });
            CloudRig blocks(scene, camera, [](Plan& plan) { plan.filterBlock = true; });
            direct.run(image), tiled.run(image), blocks.run(image);
            CHECK((!onCpu() ||
                   (blocks.points().z == direct.points().z && blocks.points().at == direct.points().at)));
            const SurfaceAgreement ofDirect = comparePoints(direct);
            CHECK(ofDirect.wrong == 0);
            CHECK(ofDirect.worst < 1e-6);
            const SurfaceAgreement ofBlocks = comparePoints(blocks);
            CHECK(ofBlocks.wrong == 0);
            CHECK(ofBlocks.worst < 1e-6);
            const reference::PointImage a = direct.points(), b = tiled.points();
            CHECK((!onCpu() ||
                   (a.z == b.z && a.at == b.at))); // a GPU's compiler rounds each variant in its own way
            const SurfaceAgreement agreement = comparePoints(tiled);
            CHECK(agreement.wrong == 0);
            CHECK(agreement.worst < 1e-6);
        }
    }
}

TEST_CASE("Polynomial weights equal their own twin's and stay within 3 % of the noise of the exact ones") {
    const CameraInfo camera = pinholeCamera(67, 41, 0.0001);
    const auto noise = [](int u, int v) {
        return 0.001 * std::sin(u * 12.9898 + v * 78.233) * std::cos(u * 3.1 - v * 7.7);
    };
    const Image image =
        drawnImage(camera, [&](int u, int v) { return (u < 30 ? 0.6 : 0.9) + 0.001 * v + noise(u, v); });
    for (const uint32_t radius : {1u, 2u, 5u}) {
        CAPTURE(radius);
        Scene scene = plainScene();
        scene.filter.radius = radius;
        CloudRig exact(scene, camera);
        scene.filter.weights = Scene::Filter::Weights::Polynomial;
        CloudRig direct(scene, camera, [](Plan& plan) { plan.tiled = plan.filterBlock = false; });
        CloudRig tiled(scene, camera, [](Plan& plan) { plan.tiled = true, plan.filterBlock = false; });
        CloudRig blocks(scene, camera, [](Plan& plan) { plan.filterBlock = true; });
        exact.run(image), direct.run(image), tiled.run(image), blocks.run(image);
        const SurfaceAgreement agreement = comparePoints(blocks);
        CHECK(agreement.points == 67 * 41);
        CHECK(agreement.wrong == 0);
        CHECK(agreement.worst < 1e-6);
        CHECK((!onCpu() || blocks.points().z == direct.points().z));
        CHECK(tiled.points().z == direct.points().z);
        const std::vector<double> a = exact.points().z, b = blocks.points().z;
        double apart = 0.0;
        for (size_t i = 0; i < a.size(); ++i) {
            apart = std::max(apart, std::abs(a[i] - b[i]));
        }
        CHECK(apart < 3e-5);
        CHECK(apart > 1e-7); // the formulas differ
    }
}

TEST_CASE(
    "Unfiltered points of a distorted lens project back onto their pixels by Brown and Conrady's formula") {
    const CameraInfo camera = freiburgCamera(428, 240);
    CloudRig rig(plainScene(), camera);
    rig.run(drawnImage(camera, [](int u, int v) { return 0.5 + 0.004 * u + 0.002 * v; }));
    const reference::PointImage points = rig.points();
    double worst = 0.0;
    const Intrinsics& lens = camera.depth;
    for (int v = 0; v < rig.height(); ++v) {
        for (int u = 0; u < rig.width(); ++u) {
            const size_t i = static_cast<size_t>(v * rig.width() + u);
            REQUIRE(points.z[i] != 0.0);
            const double x = points.at[i].x / points.at[i].z, y = points.at[i].y / points.at[i].z,
                         r2 = x * x + y * y;
            const double k = 1 + 0.2624 * r2 - 0.9531 * r2 * r2 + 1.1633 * r2 * r2 * r2;
            const double px = lens.fx * (x * k + 2 * -0.0054 * x * y + 0.0026 * (r2 + 2 * x * x)) + lens.cx;
            const double py = lens.fy * (y * k + -0.0054 * (r2 + 2 * y * y) + 2 * 0.0026 * x * y) + lens.cy;
            worst = std::max({worst, std::abs(px - u), std::abs(py - v)});
        }
    }
    CHECK(worst < 2e-4);
    MESSAGE("largest distance from its pixel ", worst, " pixels");
}

TEST_CASE("A base frame 100 km away with a moving camera loses no precision") {
    SimulatedCameraOptions options;
    options.width = 321, options.height = 241;
    const Shot shot = simulatedShot("torus", options);
    Scene scene = edgeScene(0.03);
    scene.filter.radius = 2;
    const Pose near{{0.2, -0.1, 0.4}, rotationExp({0.3, 0.2, -0.8})};
    const Pose far{near.position + dvec3(1e5, -1e5, 2e4), near.rotation};
    const Pose step{{0.05, 0.02, -0.03}, rotationExp({0.02, -0.03, 0.05})};
    CloudRig here(scene, shot.camera), there(scene, shot.camera);
    here.run(shot.image, 0.0, near), there.run(shot.image, 0.0, far);
    CHECK(here.host().spheres.x == there.host().spheres.x);
    CHECK(here.host().spheres.y == there.host().spheres.y);
    CHECK(here.host().spheres.z == there.host().spheres.z);
    CHECK(here.origin() == near.position);
    CHECK(there.origin() == far.position);
    here.run(shot.image, 0.1, near * step), there.run(shot.image, 0.1, far * step);
    const SurfaceAgreement a = comparePoints(there);
    CHECK(a.points > 1000);
    CHECK(a.wrong == 0);
    CHECK(a.worst < 1e-6);
    MESSAGE("140 km away: largest error ", a.worst * 1e6, " um a metre of range");
}

TEST_CASE(
    "A mixed pixel between two surfaces is rejected; a silhouette, a thin rod and a smooth slope are kept") {
    const CameraInfo camera = pinholeCamera(40, 30);
    const auto depth = [](int u, int v) {
        if (v < 10) { // a mixed column between a near surface and a far one
            return u < 20 ? 0.8 : u == 20 ? 0.9 : 1.0;
        }
        if (v < 20) { // a plain step, then a rod in front of it
            return u < 20 ? 0.8 : u == 30 ? 0.7 : 1.0;
        }
        return 0.8 + 0.004 * u;
    };
    CloudRig on(edgeScene(0.03), camera), off(edgeScene(0.0), camera);
    on.run(drawnImage(camera, depth)), off.run(drawnImage(camera, depth));
    CHECK_FALSE(keeps(on, 20, 5));
    CHECK(keeps(off, 20, 5));
    for (const int u : {19, 21}) {
        CHECK(keeps(on, u, 5));
    }
    for (const int u : {19, 20, 29, 30, 31}) {
        CHECK(keeps(on, u, 15));
    }
    for (int u = 0; u < 40; ++u) {
        CHECK(keeps(on, u, 25));
    }
}

TEST_CASE("A speck of up to two pixels is rejected as marine snow, and three adjacent pixels are kept") {
    const CameraInfo camera = pinholeCamera(64, 48);
    const auto depth = [](int u, int v) {
        const bool one = u == 10 && v == 10, two = (u == 30 || u == 31) && v == 10,
                   three = (u == 50 || u == 51) && v == 10;
        const bool third = u == 50 && v == 11, gap = u == 10 && (v == 30 || v == 32);
        return one || two || three || third || gap ? 0.6 : u == 10 && v == 31 ? 0.65 : 0.0;
    };
    CloudRig rig(edgeScene(0.03), camera);
    const FrameReport report = rig.run(drawnImage(camera, depth));
    CHECK(report.counts.forbidden == 9);
    CHECK_FALSE(keeps(rig, 10, 10));
    CHECK_FALSE(keeps(rig, 30, 10));
    CHECK(keeps(rig, 50, 10));
    CHECK(keeps(rig, 51, 10));
    CHECK(keeps(rig, 50, 11));
    CHECK_FALSE(keeps(rig, 10, 31)); // two neighbours, both more than 20 mm away
    CHECK(report.counts.spheres == 3);
}

TEST_CASE("The filter reduces noise on a plane as its weights predict and keeps a step") {
    const CameraInfo camera = pinholeCamera(120, 60, 0.0001);
    const auto noise = [](int u, int v) {
        return 0.001 * std::sin(u * 12.9898 + v * 78.233) * std::cos(u * 3.1 - v * 7.7);
    };
    const auto depth = [&](int u, int v) { return (u < 60 ? 0.6 : 0.9) + noise(u, v); };
    Scene scene = plainScene();
    const auto spread = [&](uint32_t radius) {
        scene.filter.radius = radius;
        CloudRig rig(scene, camera);
        rig.run(drawnImage(camera, depth));
        const reference::PointImage points = rig.points();
        double sum = 0.0;
        for (int v = 5; v < 55; ++v) {
            for (int u = 30; u < 90; ++u) {
                const double z = points.z[static_cast<size_t>(v * 120 + u)];
                CHECK(std::abs(z - (u < 60 ? 0.6 : 0.9)) < 0.0012);
                sum += (z - (u < 60 ? 0.6 : 0.9)) * (z - (u < 60 ? 0.6 : 0.9)) / 3000.0;
            }
        }
        return std::sqrt(sum);
    };
    const double raw = spread(0), filtered = spread(2);
    MESSAGE("rms ", raw * 1e3, " mm unfiltered, ", filtered * 1e3, " mm filtered");
    CHECK(filtered < 0.5 * raw);
}
