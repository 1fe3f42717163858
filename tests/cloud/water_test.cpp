// SPDX-License-Identifier: Apache-2.0
// Correction of colours for attenuation in water, in classify.comp and in its float64 twin.
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kRed = 0xff2828c8; // 0xAABBGGRR

// A colour as seen through a range of water.
uint32_t seenThrough(uint32_t rgba, const dvec3& attenuation, double range) {
    uint32_t seen = rgba & 0xff000000u;
    for (int i = 0; i < 3; ++i) {
        const double light =
            std::pow((rgba >> (8 * i) & 255) / 255.0, 2.2) * std::exp(-attenuation[i] * range);
        seen |= static_cast<uint32_t>(std::lround(255.0 * std::pow(light, 1.0 / 2.2))) << (8 * i);
    }
    return seen;
}

Scene redScene() {
    Scene scene = plainScene();
    scene.fixtures[0].hue = Band{345, 15};
    scene.fixtures[0].saturation = Band{0.4, 1.0};
    return scene;
}

uint32_t marked(const std::vector<uint32_t>& masks) {
    return static_cast<uint32_t>(
        std::count_if(masks.begin(), masks.end(), [](uint32_t m) { return m != 0; }));
}

} // namespace

TEST_CASE("Red that water has turned green is red again at every range, in the pass and in its twin") {
    const dvec3 water(0.9, 0.12, 0.08); // [1/m] coastal water: red is attenuated most
    const CameraInfo camera = pinholeCamera(123, 77);
    Image image = drawnImage(camera, [&](int u, int) { return 0.4 + 2.4 * u / 122.0; });
    Scene scene = redScene();
    scene.farZ = 3.0;
    const reference::FrameView view(scene, camera, Pose{}, image.depth, image.colour);
    for (int v = 0; v < 77; ++v) {
        for (int u = 0; u < 123; ++u) {
            const double range = glm::length(view.point(u, v, view.z(u, v)));
            image.colour[view.index(u, v)] = seenThrough(kRed, water, range);
        }
    }
    CloudRig plain(scene, camera);
    plain.run(image);
    scene.attenuation = water;
    CloudRig cleared(scene, camera);
    cleared.run(image);
    CHECK_FALSE(plain.plan().water);
    CHECK(cleared.plan().water);
    CHECK(marked(plain.masks()) < 123 * 77 * 3 / 4); // far red pixels look green
    CHECK(marked(cleared.masks()) == 123 * 77);
    const auto twin = reference::classify(cleared.view(), nullptr);
    CHECK(twin.masks == cleared.masks());
}

TEST_CASE("With water the pass marks the same pixels as its twin, except at rounding thresholds") {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const bool wide = seed % 2 == 0;
        const CameraInfo camera = wide ? freiburgCamera(131, 83) : pinholeCamera(160, 90);
        Scene scene = classesScene(1 + static_cast<uint32_t>(seed));
        scene.attenuation = dvec3(0.2 * static_cast<double>(seed), 0.11, 0.05);
        CloudRig rig(scene, camera);
        rig.run(stressImage(camera, seed));
        const auto twin = reference::classify(rig.view(), nullptr);
        const std::vector<uint32_t> masks = rig.masks();
        size_t wrong = 0, unsure = 0;
        for (size_t i = 0; i < masks.size(); ++i) {
            wrong += masks[i] != twin.masks[i] && twin.unsure[i] == 0 ? 1 : 0;
            unsure += twin.unsure[i];
        }
        CAPTURE(seed);
        CHECK(marked(masks) > 100);
        CHECK(wrong == 0);
        CHECK(unsure < masks.size() / 50);
    }
}

TEST_CASE("Colours are unchanged without attenuation or with zero attenuation") {
    const CameraInfo camera = pinholeCamera(100, 60);
    Scene scene = classesScene(5);
    CloudRig plain(scene, camera);
    scene.attenuation = dvec3(0.0);
    CloudRig zero(scene, camera);
    const Image image = stressImage(camera, 3);
    plain.run(image), zero.run(image);
    CHECK(plain.masks() == zero.masks());
    const reference::ClearColour clear = reference::withoutWater(0xff123456u, dvec3(0.0), 2.0);
    CHECK(clear.rgba == 0xff123456u);
    CHECK(reference::withoutWater(0xff000000u, dvec3(5.0), 3.0).rgba == 0xff000000u); // black stays
    CHECK(reference::withoutWater(0xff808080u, dvec3(5.0), 3.0).rgba == 0xffffffffu); // no more than white
}
