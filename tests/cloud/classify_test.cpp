// SPDX-License-Identifier: Apache-2.0
// Compares classify.comp with its float64 twin: class bits, the list of patches, counts.
#include "apps/verify/read_back.h"
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Agreement {
    uint32_t marked = 0, different = 0, unsure = 0, wrong = 0; // wrong: different away from thresholds
};

Agreement compareMasks(const CloudRig& rig) {
    const bool look = rig.plan().occlusion;
    const reference::CellImage cells = look ? rig.cells() : reference::CellImage{};
    const reference::ClassImage twin = reference::classify(rig.view(), look ? &cells : nullptr);
    const std::vector<uint32_t> masks = rig.masks();
    Agreement a;
    for (size_t i = 0; i < masks.size(); ++i) {
        const bool different = masks[i] != twin.masks[i];
        a.marked += masks[i] != 0;
        a.unsure += twin.unsure[i];
        a.different += different;
        a.wrong += different && twin.unsure[i] == 0;
    }
    return a;
}

// Exactly the patches with a class pixel are listed, once each. Counters equal the sums over the masks.
void checkList(CloudRig& rig) {
    const std::vector<uint32_t> masks = rig.masks(), listed = rig.listed();
    const shared::FrameCounters counters = rig.counters();
    const uint32_t across = rig.cycle().layout().across;
    std::vector<uint32_t> expected(rig.cycle().layout().patches(), 0);
    std::array<uint32_t, 8> pixels{};
    for (size_t i = 0; i < masks.size(); ++i) {
        const size_t u = i % rig.camera().depth.width, v = i / rig.camera().depth.width;
        expected[v / 16 * across + u / 16] |= masks[i] != 0;
        for (size_t c = 0; c < 8; ++c) {
            pixels[c] += masks[i] >> c & 1;
        }
    }
    CHECK(std::equal(expected.begin(), expected.end(), listed.begin(),
                     [](uint32_t here, uint32_t there) { return here == (there & shared::kPatchListed); }));
    auto list = verify::readBack<uint32_t>(vulkan().device, rig.cycle().work().list);
    const auto count = static_cast<size_t>(std::count(expected.begin(), expected.end(), 1u));
    REQUIRE(counters.patchGroups.x == count);
    std::sort(list.begin(), list.begin() + static_cast<long>(count));
    CHECK(std::adjacent_find(list.begin(), list.begin() + static_cast<long>(count)) ==
          list.begin() + static_cast<long>(count));
    CHECK(std::all_of(list.begin(), list.begin() + static_cast<long>(count),
                      [&](uint32_t p) { return expected[p] == 1; }));
    CHECK(counters.subPatchGroups.x ==
          (count * 16 + rig.plan().subPatchGroup - 1) / rig.plan().subPatchGroup);
    for (size_t c = 0; c < 8; ++c) {
        CHECK(counters.classPixels[c] == pixels[c]);
    }
}

// A frame at one depth with all colours on a grid of channel values, and greys.
Image allColours(CameraInfo& camera) {
    camera = pinholeCamera(512, 128);
    Image image = drawnImage(camera, [](int, int) { return 1.0; });
    for (size_t i = 0; i < image.colour.size(); ++i) {
        // 40 x 40 x 40 grid of channel values with uneven steps, then greys
        const auto channel = [](size_t k) { return static_cast<uint32_t>(k * 255 / 39); };
        const size_t k = i % 65536;
        image.colour[i] = k < 64000 ? channel(k % 40) | channel(k / 40 % 40) << 8 | channel(k / 1600) << 16
                                    : static_cast<uint32_t>(k % 256) * 0x010101u;
    }
    return image;
}

struct Bounds {
    std::optional<Band> hue, saturation, lightness;
};
// Bounds that exact quotients of bytes hit: fifths, eighths and 17ths of 255, and bounds of three decimals.
const std::vector<Bounds> kBounds = {{Band{60, 120}, {}, {}},
                                     {Band{345, 15}, {}, {}},
                                     {Band{0, 0}, {}, {}},
                                     {Band{300, 300}, {}, {}},
                                     {Band{22.5, 97.5}, {}, {}},
                                     {Band{337.5, 7.5}, {}, {}},
                                     {Band{84.3, 200.7}, {}, {}},
                                     {Band{0, 360}, {}, {}},
                                     {{}, Band{0.2, 0.6}, {}},
                                     {{}, Band{0.125, 0.875}, {}},
                                     {{}, {}, Band{0.2, 0.4}},
                                     {{}, {}, Band{0.502, 0.498}},
                                     {{}, Band{0, 0}, {}},
                                     {{}, Band{1, 1}, {}},
                                     {{}, {}, Band{0, 0}},
                                     {{}, {}, Band{1, 1}},
                                     {Band{330.33, 12.48}, Band{0.048, 1}, Band{0.05, 0.9}},
                                     {Band{0.24, 359.76}, {}, {}},
                                     {Band{11.25, 348.75}, {}, {}},
                                     {Band{4.8, 100.8}, Band{0.333, 0.667}, {}}};

} // namespace

TEST_CASE("Class bits equal the twin's at every pixel away from thresholds, for every size, lens, unit and "
          "set of classes") {
    uint32_t different = 0, marked = 0;
    for (const CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        CloudRig rig(c.scene, c.camera);
        const FrameReport report = rig.run(c.image);
        const Agreement a = compareMasks(rig);
        CHECK(a.wrong == 0);
        CHECK(a.different <= 2);
        CHECK(report.counts.valid == reference::validPixels(rig.view()));
        checkList(rig);
        different += a.different, marked += a.marked;
    }
    CHECK(marked > (kSanitized ? 50000 : 400000));
    MESSAGE("classify: ", different, " of ", marked,
            " marked pixels differ, all of them within 1e-6 of a box face");
}

TEST_CASE(
    "Colour bounds are inclusive to the last bit, wrap through 0, and grey, black and white have no hue") {
    CameraInfo camera;
    const Image image = allColours(camera);
    uint32_t pixels = 0;
    for (size_t first = 0; first < kBounds.size(); first += 8) {
        Scene scene = plainScene();
        scene.fixtures.clear();
        for (size_t k = first; k < std::min(first + 8, kBounds.size()); ++k) {
            FixtureClass f = forbiddenClass("c", 0.01);
            f.hue = kBounds[k].hue, f.saturation = kBounds[k].saturation, f.lightness = kBounds[k].lightness;
            scene.fixtures.push_back(f);
        }
        CloudRig rig(scene, camera);
        rig.run(image);
        const Agreement a = compareMasks(rig);
        CHECK(a.different == 0);
        pixels += a.marked;
    }
    CHECK(pixels > 50000);
}

TEST_CASE("A hue band of zero width accepts exactly the pixels whose hue is that fraction") {
    const CameraInfo camera = pinholeCamera(256, 64);
    Image image = drawnImage(camera, [](int, int) { return 1.0; });
    // Spreads whose sixtieths have at most three decimals: hue = 60 k / spread.
    constexpr std::array<uint32_t, 6> kSpreads{125, 160, 200, 240, 250, 96};
    for (size_t i = 0; i < image.colour.size(); ++i) {
        const uint32_t d = kSpreads[i % 6], k = static_cast<uint32_t>(i / 6) % (6 * d), rest = k % d;
        const uint32_t lo = 5, hi = lo + d, up = lo + rest, down = hi - rest;
        const std::array<std::array<uint32_t, 3>, 6> sectors{
            {{hi, up, lo}, {down, hi, lo}, {lo, hi, up}, {lo, down, hi}, {up, lo, hi}, {hi, lo, down}}};
        const auto& c = sectors[k / d];
        image.colour[i] = c[0] | c[1] << 8 | c[2] << 16;
    }
    uint32_t marked = 0;
    for (uint32_t rigs = 0; rigs < 4; ++rigs) {
        Scene scene = plainScene();
        scene.fixtures.clear();
        for (uint32_t c = 0; c < 8; ++c) {
            const uint32_t d = kSpreads[c % 6];
            const double hue = 60.0 * ((rigs * 977 + c * 389 + 131) % (6 * d)) / d;
            scene.fixtures.push_back(forbiddenClass("one hue", 0.01));
            scene.fixtures.back().hue = Band{hue, hue};
        }
        CloudRig rig(scene, camera);
        const FrameReport report = rig.run(image);
        CHECK(compareMasks(rig).different == 0);
        for (const uint32_t pixels : report.counts.classPixels) {
            CHECK(pixels > 0);
            marked += pixels;
        }
    }
    MESSAGE(marked, " pixels lie exactly on both bounds of their band");
}

TEST_CASE("The hue gate alone rejects grey pixels, and a class without gates accepts every valid pixel") {
    const CameraInfo camera = pinholeCamera(48, 3);
    Image image = drawnImage(camera, [](int u, int) { return u % 3 == 2 ? 0.0 : 0.8; });
    for (size_t i = 0; i < image.colour.size(); ++i) {
        image.colour[i] = i % 4 == 0 ? 0u : i % 4 == 1 ? 0xffffffu : i % 4 == 2 ? 0x808080u : 0x2020c0u;
    }
    Scene scene = plainScene();
    scene.fixtures = {forbiddenClass("red", 0.01), forbiddenClass("all", 0.02)};
    scene.fixtures[0].hue = Band{0, 360};
    CloudRig rig(scene, camera);
    const FrameReport report = rig.run(image);
    CHECK(report.counts.valid == 96);
    CHECK(report.counts.classPixels[1] == 96);
    CHECK(report.counts.classPixels[0] == 24);
    CHECK(compareMasks(rig).different == 0);
}

TEST_CASE("Near and far bounds at exact depth units are inclusive for every unit, and depth 0 never counts") {
    for (const double unit : {0.001, 0.0002, 0.0001, 0.00012345}) {
        CAPTURE(unit);
        const CameraInfo camera = pinholeCamera(64, 40, unit);
        Scene scene = plainScene();
        scene.nearZ = 700 * unit, scene.farZ = 2300 * unit;
        Image image = drawnImage(camera, [](int, int) { return 0.0; });
        for (size_t i = 0; i < image.depth.size(); ++i) {
            image.depth[i] = static_cast<uint16_t>(i + 200); // 200 .. 2759
        }
        image.depth[5] = 0, image.depth[6] = 65535;
        CloudRig rig(scene, camera);
        const FrameReport report = rig.run(image);
        CHECK(report.counts.valid == 1601);
        CHECK(report.counts.classPixels[0] == 1601);
        CHECK(compareMasks(rig).different == 0);
        CHECK(report.counts.forbidden == 1601);
    }
}

TEST_CASE("Without colour, a class with colour gates accepts no pixel and a class without them accepts all") {
    CameraInfo camera = pinholeCamera(37, 21);
    camera.hasColour = false;
    Image image = drawnImage(camera, [](int, int) { return 0.8; });
    image.colour.clear();
    Scene scene = plainScene();
    scene.fixtures = {forbiddenClass("dark", 0.01), forbiddenClass("grey", 0.01),
                      forbiddenClass("any hue", 0.01), forbiddenClass("all", 0.02)};
    scene.fixtures[0].lightness = Band{0, 0.5}; // includes black, the value of a missing colour
    scene.fixtures[1].saturation = Band{0, 0.5};
    scene.fixtures[2].hue = Band{0, 360};
    CloudRig rig(scene, camera);
    const FrameReport report = rig.run(image);
    CHECK(report.counts.classPixels[0] == 0);
    CHECK(report.counts.classPixels[1] == 0);
    CHECK(report.counts.classPixels[2] == 0);
    CHECK(report.counts.classPixels[3] == 37 * 21);
    CHECK(compareMasks(rig).different == 0);
}

TEST_CASE("A depth range that contains no depth unit accepts no pixel") {
    const CameraInfo camera = pinholeCamera(37, 21, 0.001);
    const Image image = drawnImage(camera, [](int u, int) { return 0.5 + 0.001 * (u % 3); });
    Scene scene = plainScene();
    scene.fixtures = {forbiddenClass("all", 0.01)};
    scene.nearZ = 0.5002, scene.farZ = 0.5008; // between 500 and 501 units
    CloudRig rig(scene, camera);
    CHECK(rig.run(image).counts.classPixels[0] == 0);
    CHECK(compareMasks(rig).different == 0);
}

TEST_CASE("A box accepts points exactly on its faces") {
    const CameraInfo camera = [] {
        CameraInfo c = pinholeCamera(40, 40);
        c.depth.fx = c.depth.fy = 100.0, c.depth.cx = c.depth.cy = 20.0; // x = (u - 20) z / 100
        return c;
    }();
    for (const int z : {500, 999, 1000, 777, 2047, 1999}) {
        CAPTURE(z);
        for (const dvec3 offset : {dvec3(0.0), dvec3(0.1, -3.7, 12.3), dvec3(1e5, -1e5, 77.7)}) {
            const double metres = 0.001 * z;
            Scene scene = plainScene();
            scene.baseTcamera.position = offset;
            scene.fixtures[0].box = Box{offset + dvec3(-0.1 * metres, -0.05 * metres, metres),
                                        offset + dvec3(0.07 * metres, 0.05 * metres, metres)};
            CloudRig rig(scene, camera);
            const FrameReport report = rig.run(drawnImage(camera, [&](int, int) { return metres; }));
            CHECK(report.counts.classPixels[0] == 18 * 11);
        }
    }
}

TEST_CASE("Frames without depth, with all pixels selected and with none selected are processed") {
    const CameraInfo camera = pinholeCamera(100, 50);
    Scene scene = classesScene(2);
    scene.fixtures[0] = forbiddenClass("all", 0.03);
    scene.fixtures[1].hue = Band{100, 110};
    CloudRig rig(scene, camera);
    const FrameReport none = rig.run(drawnImage(camera, [](int, int) { return 0.0; }));
    CHECK(none.counts.valid == 0);
    CHECK(none.counts.spheres == 0);
    CHECK(rig.counters().patchGroups.x == 0);
    CHECK(rig.host().guidance[0].count == 0);
    const FrameReport all = rig.run(drawnImage(camera, [](int, int) { return 1.0; }));
    CHECK(all.counts.forbidden == 5000);
    CHECK(all.counts.spheres == 5000);
    CHECK(all.counts.classPixels[1] == 0);
    const FrameReport far = rig.run(drawnImage(camera, [](int, int) { return 20.0; }));
    CHECK(far.counts.valid == 0);
    CHECK(far.counts.spheres == 0);
    CHECK(rig.host().spheres.size() == 0);
}
