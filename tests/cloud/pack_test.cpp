// SPDX-License-Identifier: Apache-2.0
// Compares the spheres that the host reads, packed or from radii, with the slots, one by one and in order.
#include "tests/cloud/pack_check.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <map>
#include <set>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE(
    "The host reads every sphere of every slot once and in order, also at sizes that are not whole patches") {
    for (const glm::uvec2 size :
         std::initializer_list<glm::uvec2>{{1, 1}, {16, 16}, {17, 33}, {67, 41}, {320, 240}}) {
        const uint32_t width = size.x, height = size.y;
        CAPTURE(width);
        CAPTURE(height);
        const CameraInfo camera = pinholeCamera(width, height);
        for (const bool pack : {false, true}) {
            CloudRig rig(plainScene(), camera, packing(pack));
            rig.run(stressImage(camera, width));
            checkPacked(rig);
        }
    }
}

TEST_CASE("Held spheres follow the seen ones of their patch, without thinned ones") {
    const CameraInfo camera = pinholeCamera(130, 70);
    Scene scene = plainScene();
    scene.holdSeconds = 1.0;
    scene.errorBudget = 0.001;
    bool pack = false;
    SUBCASE("read from slots") {}
    SUBCASE("packed") {
        pack = true;
    }
    CloudRig rig(scene, camera, packing(pack));
    const Image whole = drawnImage(camera, [](int u, int) { return 1.0 + 0.001 * u; });
    rig.run(whole);
    checkPacked(rig);
    Image holes = whole;
    for (size_t p = 0; p < holes.depth.size(); p += 3) {
        holes.depth[p] = 0;
    }
    rig.run(holes);
    checkPacked(rig);
    CHECK(std::any_of(rig.host().spheres.source.begin(), rig.host().spheres.source.end(),
                      [](uint32_t source) { return source >= 130 * 70; }));
}

TEST_CASE(
    "Frames without points, with few points at the corner of four patches and with all points are packed") {
    const CameraInfo camera = pinholeCamera(66, 50);
    for (const int points : {0, 16, 66 * 50}) {
        CAPTURE(points);
        CloudRig rig(plainScene(), camera, packing(true));
        rig.run(drawnImage(camera, [&](int u, int v) {
            return points > 16 || (points == 16 && (u + 2) / 4 == 12 && (v + 2) / 4 == 8) ? 1.0 : 0.0;
        }));
        CHECK(rig.host().spheres.size() == static_cast<size_t>(points));
        checkPacked(rig);
    }
}

TEST_CASE("A set laid out by several threads equals that of a single thread") {
    const CameraInfo camera = pinholeCamera(321, 243);
    bool pack = false;
    SUBCASE("read from slots") {}
    SUBCASE("packed") {
        pack = true;
    }
    const auto shared = [pack](uint32_t threads) {
        return [=](Plan& plan) {
            packing(pack)(plan);
            plan.publishers = threads;
        };
    };
    Scene scene = classesScene(3);
    scene.holdSeconds = 1.0;
    CloudRig one(scene, camera, shared(1)), three(scene, camera, shared(3));
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Image image = stressImage(camera, seed);
        for (size_t p = seed; seed > 1 && p < image.depth.size(); p += 5) { // gives held spheres, too
            image.depth[p] = 0;
        }
        const FrameReport a = one.run(image), b = three.run(image);
        checkPacked(three);
        const RegionSpheres &s = one.host().spheres, &t = three.host().spheres;
        CHECK(s.size() > 8192); // more than two parts
        CHECK((s.x == t.x && s.y == t.y && s.z == t.z && s.radius == t.radius));
        CHECK((s.source == t.source && s.fixture == t.fixture));
        CHECK(a.counts.patches == b.counts.patches);
        CHECK(a.counts.classSpheres == b.counts.classSpheres);
        CHECK(a.counts.classPatches == b.counts.classPatches);
        CHECK(std::ranges::equal(one.set().grid.get().order(), three.set().grid.get().order()));
    }
}

TEST_CASE("Packing is unchanged when a GPU query keeps slots") {
    const CameraInfo camera = pinholeCamera(90, 40);
    Scene scene = plainScene();
    scene.holdSeconds = 1.0;
    CloudRig rig(scene, camera, [](Plan& plan) {
        plan.query = Plan::Query::Gpu;
        packing(true)(plan);
    });
    Image image = stressImage(camera, 5);
    rig.run(image);
    checkPacked(rig);
    for (size_t p = 0; p < image.depth.size(); p += 3) { // points here are held from now on
        image.depth[p] = 0;
    }
    rig.run(image);
    checkPacked(rig);
    const RegionSpheres& host = rig.host().spheres;
    CHECK(std::ranges::any_of(host.source, [](uint32_t source) { return source >= 90 * 40; })); // held
}

TEST_CASE(
    "Packed spheres have the classes of their slots, in patches of one class and of several, seen and held") {
    const CameraInfo camera = pinholeCamera(150, 70);
    for (const uint32_t classes : {1u, 3u, 8u}) {
        CAPTURE(classes);
        Scene scene = classesScene(classes);
        scene.holdSeconds = 1.0;
        CloudRig packed(scene, camera, packing(true)), slots(scene, camera, packing(false));
        std::map<uint32_t, std::set<uint8_t>> ofPatch;
        bool held = false;
        for (const uint64_t seed : {3, 4, 5}) {
            Image image = stressImage(camera, 3);
            for (size_t p = 0; seed > 3 && p < image.depth.size(); p += seed) { // gives held spheres, too
                image.depth[p] = 0;
            }
            const FrameReport one = packed.run(image), other = slots.run(image);
            CHECK(one.counts.classSpheres == other.counts.classSpheres);
            CHECK(one.counts.classPatches == other.counts.classPatches);
            const RegionSpheres &a = packed.host().spheres, &b = slots.host().spheres;
            REQUIRE(a.source == b.source);
            CHECK(a.fixture == b.fixture);
            for (size_t i = 0; i < a.size(); ++i) {
                const uint32_t pixel = a.source[i] % (150 * 70);
                held = held || a.source[i] != pixel;
                ofPatch[pixel / 150 / 16 * 16 + pixel % 150 / 16].insert(a.fixture[i]);
            }
        }
        const auto several =
            std::ranges::count_if(ofPatch, [](const auto& patch) { return patch.second.size() > 1; });
        CHECK(held);
        CHECK((several > 0) == (classes > 1));
        CHECK((classes == 8 || several < static_cast<std::ptrdiff_t>(ofPatch.size())));
    }
}
