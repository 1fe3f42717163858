// SPDX-License-Identifier: Apache-2.0
// Guidance options: the largest connected part and the trimmed mean.
#include "engine/reference/guidance.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

FixtureClass chosenClass() {
    FixtureClass f = guidanceClass("goal");
    f.standoff = 0.05;
    return f;
}

Scene sceneOfChosen(const FixtureClass& f) {
    Scene scene = plainScene();
    scene.fixtures = {f};
    return scene;
}

void checkSame(const CloudRig& rig, const std::vector<dvec3>& points) {
    const GuidancePose& here = rig.host().guidance[0];
    const GuidancePose there =
        reference::guidance(points, rig.scene().fixtures[0], rig.host().baseTcamera.position);
    CHECK(here.count == there.count);
    CHECK(here.planar == there.planar);
    CHECK(glm::distance(here.position, there.position) < 1e-6);
    CHECK(glm::distance(here.target.position, there.target.position) < 1e-5);
}

} // namespace

TEST_CASE("The largest connected part and the trimmed mean drop the same points as the twin") {
    const CameraInfo camera = pinholeCamera(200, 150, 0.0001);
    // Two parts of the class, the larger on the right, and a third part next to it behind a depth jump.
    const auto depth = [](int u, int v) {
        const bool small = u > 20 && u < 50 && v > 20 && v<50, large = u> 90 && u < 150 && v > 40 && v < 120,
                   behind = u >= 150 && u < 190 && v > 40 && v < 120;
        return small ? 0.5 : large ? 0.7 + 0.0005 * v : behind ? 1.2 : 0.0;
    };
    for (const bool largest : {false, true}) {
        for (const double trim : {0.0, 0.1, 0.5}) {
            for (const double edge : {0.0, 0.03}) {
                CAPTURE(largest);
                CAPTURE(trim);
                CAPTURE(edge);
                FixtureClass f = chosenClass();
                f.largestPart = largest, f.trim = trim;
                Scene scene = sceneOfChosen(f);
                scene.filter.edge = edge;
                CloudRig rig(scene, camera);
                rig.run(drawnImage(camera, depth));
                CHECK(static_cast<bool>(rig.set().device.points) == (largest || trim > 0.0));
                auto masks = rig.masks();
                const auto all = rig.points();
                if (largest) {
                    const auto part = reference::largestPart(rig.width(), rig.height(), masks, all, 0, edge);
                    std::transform(part.begin(), part.end(), masks.begin(), [](uint8_t in) { return in; });
                }
                const auto points = reference::trimmed(reference::pointsOfClass(masks, all, 0), trim);
                checkSame(rig, points);
                const double x = rig.host().guidance[0].position.x;
                CHECK((!largest || x > 0.0));
            }
        }
    }
}

TEST_CASE("The largest part of scattered pixels equals the twin's for winding shapes") {
    const CameraInfo camera = pinholeCamera(131, 77, 0.0001);
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        std::vector<double> depth(size_t{131} * 77, 0.0);
        for (double& z : depth) { // density at which parts begin to span the image
            const auto r = random() % 1000;
            z = r < 360 + 10 * seed ? 0.6 : r < 500 ? 0.62 : 0.0;
        }
        FixtureClass f = chosenClass();
        f.largestPart = true;
        Scene scene = sceneOfChosen(f);
        scene.filter.edge = seed % 2 == 0 ? 0.02 : 0.0;
        scene.filter.radius = 0;
        CloudRig rig(scene, camera);
        rig.run(drawnImage(camera, [&](int u, int v) { return depth[static_cast<size_t>(v * 131 + u)]; }));
        const auto part = reference::largestPart(131, 77, rig.masks(), rig.points(), 0, scene.filter.edge);
        const std::vector<uint32_t> masks(part.begin(), part.end());
        const auto points = reference::pointsOfClass(masks, rig.points(), 0);
        CHECK(points.size() > 50);
        checkSame(rig, points);
    }
}

TEST_CASE("Of equally large parts the first one is chosen") {
    const CameraInfo camera = pinholeCamera(80, 60, 0.0001);
    for (const int top : {9, 20}) {
        FixtureClass f = chosenClass();
        f.largestPart = true;
        CloudRig rig(sceneOfChosen(f), camera);
        rig.run(drawnImage(camera, [&](int u, int v) { // the left part ends last
            const bool left = u >= 8 && u < 24 && v >= top && v < top + 24,
                       right = u >= 50 && u < 74 && v >= 10 && v < 26;
            return left || right ? 0.6 : 0.0;
        }));
        CHECK((rig.host().guidance[0].position.x < 0.0) == (top < 10));
    }
}

TEST_CASE("The trimmed mean leaves a target as many points as the plain one: min_count counts before it") {
    const CameraInfo camera = pinholeCamera(64, 48, 0.0001);
    const auto patch = [](int u, int v) { return u >= 20 && u < 28 && v >= 20 && v < 28 ? 0.5 : 0.0; };
    for (const uint32_t least : {40u, 64u, 65u}) {
        for (const double trim : {0.0, 0.5}) {
            CAPTURE(least);
            CAPTURE(trim);
            FixtureClass f = chosenClass();
            f.trim = trim, f.minCount = least;
            CloudRig rig(sceneOfChosen(f), camera);
            rig.run(drawnImage(camera, patch));
            const GuidancePose& pose = rig.host().guidance[0];
            CHECK(pose.count == (trim > 0.0 ? 32u : 64u));
            CHECK(pose.present == (least <= 64));
        }
    }
}
