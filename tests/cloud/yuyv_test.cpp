// SPDX-License-Identifier: Apache-2.0
// classify.comp with YUYV, compared with its twin and with the same colours sent unpacked.
#include "devices/frame_slots.h"
#include "engine/types/error.h"
#include "engine/types/yuyv.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::test;

namespace {

CameraInfo sendsYuyv(CameraInfo camera) {
    camera.yuyv = true;
    return camera;
}

// A second camera of another size, 50 mm to the side.
CameraInfo beside(CameraInfo camera) {
    camera.registered = false;
    camera.colour.width = 202, camera.colour.height = 75;
    camera.colour.cx = 100.7, camera.colour.cy = 36.2;
    camera.colour.fx = camera.colour.fy = 190.0;
    camera.colourTdepth = {{0.05, 0.002, 0.001}, rotationExp({0.002, 0.004, -0.003})};
    return camera;
}

// Random bytes: most words have no colour in the RGB gamut.
std::vector<uint32_t> anyWords(const CameraInfo& camera) {
    std::mt19937 random(7);
    std::vector<uint32_t> words(camera.colour.pixels() / 2);
    std::ranges::generate(words, [&] { return static_cast<uint32_t>(random()); });
    return words;
}

Scene gates() {
    Scene scene = plainScene();
    scene.fixtures.clear();
    for (uint32_t c = 0; c < 8; ++c) {
        FixtureClass f = forbiddenClass("c", 0.01);
        if (c < 4) {
            f.hue = Band{90.0 * c, 90.0 * c + 70.0};
        } else {
            f.lightness = Band{0.1 * c, 0.1 * c + 0.2};
            f.saturation = Band{0.1 * c, 1.0};
        }
        scene.fixtures.push_back(f);
    }
    return scene;
}

// Class bits of one frame with these colour words.
std::vector<uint32_t> masksOf(const Scene& scene, const CameraInfo& camera, const Frame::Content& content,
                              const CloudRig::Change& change = {}) {
    CloudRig rig(scene, camera, change);
    rig.cycle().process(Frame(content, nullptr));
    return rig.masks();
}

uint32_t countOf(const std::vector<uint32_t>& masks) {
    return static_cast<uint32_t>(std::ranges::count_if(masks, [](uint32_t m) { return m != 0; }));
}

// Uses a GPU's layout of invocations on any device.
void forGpu(Plan& plan) {
    plan.byPixel = plan.pack = true;
    plan.memoryTexels = plan.filterBlock = false;
}

// Compares the words with the host's unpacked colours.
void checkSame(const Scene& scene, const CameraInfo& camera) {
    const Image image = drawnImage(camera, [](int u, int) { return u % 7 == 6 ? 0.0 : 0.9; });
    const std::vector<uint32_t> words = anyWords(camera);
    std::vector<uint32_t> rgba(camera.colour.pixels());
    unpackYuyv(words, rgba);
    Frame::Content sent, plain;
    sent.depth = plain.depth = image.depth;
    sent.yuyv = words, plain.colour = rgba;
    const auto masks = masksOf(scene, sendsYuyv(camera), sent);
    CHECK(masks == masksOf(scene, camera, plain));
    CHECK(masks == masksOf(scene, sendsYuyv(camera), sent, [&](Plan& plan) {
              forGpu(plan);
              plan.keepDepth = camera.depth.width % 4 == 0;
          }));
    CHECK(countOf(masks) > camera.depth.pixels() / 4);
}

} // namespace

TEST_CASE("Classes from YUYV equal the twin's at widths that are and are not multiples of four") {
    for (const glm::uvec2 size : {glm::uvec2(2, 1), glm::uvec2(62, 33), glm::uvec2(64, 48),
                                  glm::uvec2(130, 35), glm::uvec2(204, 117)}) {
        CAPTURE(size.x);
        const CameraInfo camera = sendsYuyv(pinholeCamera(size.x, size.y));
        CloudRig rig(classesScene(8), camera);
        const Image image = stressImage(camera, size.x);
        rig.run(image);
        const reference::ClassImage twin = reference::classify(rig.view(), nullptr);
        const std::vector<uint32_t> masks = rig.masks();
        uint32_t wrong = 0;
        for (size_t i = 0; i < masks.size(); ++i) {
            wrong += masks[i] != twin.masks[i] && twin.unsure[i] == 0;
        }
        CHECK(wrong == 0);
        if (size.x > 2) {
            CHECK(countOf(masks) > camera.depth.pixels() / 4);
        }
    }
}

TEST_CASE("Colour is uploaded as YUYV, in half the bytes, if a class uses it and the camera sends it") {
    const CameraInfo camera = pinholeCamera(64, 48);
    Scene scene = gates();
    const auto planOf = [&](const CameraInfo& of) { return makePlan(scene, of, 1, vulkan().device.facts()); };
    const auto bytesOf = [&](const Plan& plan) {
        return std::ranges::find(plan.items, "colour upload", &Plan::Item::name)->bytes;
    };
    const Plan plain = planOf(camera), packed = planOf(sendsYuyv(camera));
    CHECK_FALSE(plain.yuyv);
    CHECK(packed.yuyv);
    CHECK(bytesOf(plain) == 2 * 4 * 64 * 48);
    CHECK(bytesOf(packed) == 2 * 2 * 64 * 48);
    scene = plainScene();
    CHECK_FALSE(planOf(sendsYuyv(camera)).yuyv);
    CHECK(bytesOf(planOf(sendsYuyv(camera))) == 0);
}

TEST_CASE("Every YUYV word has the classes of its host-unpacked colours, to the last bit") {
    checkSame(gates(), pinholeCamera(640, 480)); // 153600 words, four pixels per fetch
    checkSame(gates(), pinholeCamera(322, 241)); // two
}

TEST_CASE("Colours looked up in another camera's YUYV image equal those of the unpacked image") {
    checkSame(gates(), beside(pinholeCamera(160, 120)));
}

TEST_CASE("YUYV colours are corrected for water like others") {
    Scene scene = gates();
    scene.attenuation = dvec3(0.6, 0.15, 0.1);
    checkSame(scene, pinholeCamera(322, 241));
}

TEST_CASE("A YUYV camera with an odd colour width is rejected") {
    const CameraInfo camera = sendsYuyv(pinholeCamera(63, 48));
    CHECK_THROWS_WITH_AS(
        makePlan(gates(), camera, 1, vulkan().device.facts()),
        "camera: width of its YUYV colour: 63 (allowed: even, because two pixels share a word)", BadInput);
}

TEST_CASE("A frame without the announced YUYV image or with a missing row is rejected") {
    const CameraInfo camera = sendsYuyv(pinholeCamera(64, 48));
    CloudRig rig(classesScene(3), camera);
    const Image image = stressImage(camera, 1);
    const std::vector<uint32_t> words(64 * 47 / 2);
    Frame::Content content;
    content.depth = image.depth, content.colour = image.colour;
    CHECK_THROWS_WITH_AS(rig.cycle().process(Frame(content, nullptr)),
                         "frame: YUYV image of 0 bytes, needs 6144", Error);
    content.yuyv = words;
    CHECK_THROWS_WITH_AS(rig.cycle().process(Frame(content, nullptr)),
                         "frame: YUYV image of 6016 bytes, needs 6144", Error);
}

TEST_CASE("YUYV in whole pages is read in place and gives the results of a copy") {
    const CameraInfo camera = sendsYuyv(pinholeCamera(204, 117));
    const std::vector<uint32_t> words = anyWords(camera);
    const Image image = drawnImage(camera, [](int, int) { return 0.9; });
    FrameSlots slots(camera.depth.pixels(), true, 1);
    FrameSlot& slot = *slots.acquire();
    std::ranges::copy(image.depth, slot.depth().begin());
    std::ranges::copy(words, slot.colour().begin());
    Frame::Content content;
    content.depth = slot.depth(), content.yuyv = slot.colour().first(words.size());
    CloudRig rig(gates(), camera);
    const FrameReport report = rig.cycle().process(slot.lend(content));
    CHECK(report.inPlace == rig.plan().inPlace);
    cloud::UploadSlots uploads(vulkan().device, rig.plan(), camera);
    const auto choice = uploads.choose(slot.lend(content), {});
    CHECK(uploads[choice.slot].colour.imported() == rig.plan().inPlace);
    const auto inPlace = rig.masks();
    content.depth = image.depth, content.yuyv = words;
    CHECK(inPlace == masksOf(gates(), camera, content));
    CHECK(countOf(inPlace) > camera.depth.pixels() / 2);
}
