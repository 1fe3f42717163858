// SPDX-License-Identifier: Apache-2.0
// classify.comp with every format of colour, compared with its twin and with the same colours sent unpacked.
#include "devices/frame_slots.h"
#include "engine/types/error.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

CameraInfo sends(ColourFormat format, CameraInfo camera) {
    camera.colourFormat = format;
    return camera;
}

// A second camera of another size, 50 mm to the side.
CameraInfo secondCamera(CameraInfo camera) {
    camera.registered = false;
    camera.colour.width = 203, camera.colour.height = 75;
    camera.colour.cx = 100.7, camera.colour.cy = 36.2;
    camera.colour.fx = camera.colour.fy = 190.0;
    camera.colourTdepth = {{0.05, 0.002, 0.001}, rotationExp({0.002, 0.004, -0.003})};
    return camera;
}

// Formats, and planes of every sampling that cameras and motion JPEG use.
std::vector<RawColour> formatsOf(uint32_t w, uint32_t h) {
    const uint32_t pairs = (w + 1) / 2, fourths = (w + 3) / 4, down = (h + 1) / 2, luma = 4 * fourths;
    const auto jpeg = [&](uint32_t step, uint32_t across, uint32_t rows, uint32_t shared) {
        const ColourPlanes p{luma, luma * h, luma * h + step * rows, step, across, shared, 0};
        return RawColour{ColourFormat::JpegPlanes, w, h, {}, p};
    };
    const ColourPlanes nv12{w, w * h, w * h + 1, 2 * pairs, 1, 1, 1},
        nv21{w, w * h + 1, w * h, 2 * pairs, 1, 1, 1}, i420{w, w * h, w * h + pairs * down, pairs, 1, 1, 0};
    return {{ColourFormat::Yuyv, w, h, {}},
            {ColourFormat::Uyvy, w, h, {}},
            {ColourFormat::Rgb, w, h, {}},
            {ColourFormat::Bgr, w, h, {}},
            {ColourFormat::Planes, w, h, {}, nv12},
            {ColourFormat::Planes, w, h, {}, nv21},
            {ColourFormat::Planes, w, h, {}, i420},
            jpeg(luma, 0, h, 0),                                                             // 4:4:4
            jpeg((pairs + 3) / 4 * 4, 1, h, 0),                                              // 4:2:2
            jpeg((pairs + 3) / 4 * 4, 1, down, 1),                                           // 4:2:0
            jpeg(luma, 0, down, 1),                                                          // 4:4:0
            jpeg((fourths + 3) / 4 * 4, 2, h, 0),                                            // 4:1:1
            {ColourFormat::JpegPlanes, w, h, {}, {luma, luma * h, luma * h, 0, 31, 31, 0}}}; // grey
}

// Random bytes: most have no colour in the RGB gamut.
std::vector<std::byte> anyBytes(uint64_t count) {
    std::mt19937 random(7);
    std::vector<std::byte> bytes(count);
    std::ranges::generate(bytes, [&] { return static_cast<std::byte>(random() & 255); });
    return bytes;
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

// Compares the classes of an image with those of the colours that the host unpacks from it.
void checkSame(const Scene& scene, const CameraInfo& camera, RawColour raw) {
    CAPTURE(nameOf(raw.format));
    CAPTURE(raw.planes.across);
    CAPTURE(raw.planes.down);
    const Image image = drawnImage(camera, [](int u, int) { return u % 7 == 6 ? 0.0 : 0.9; });
    const std::vector<std::byte> bytes = anyBytes(raw.needed());
    raw.bytes = bytes;
    std::vector<uint32_t> rgba(camera.colour.pixels());
    unpackColour(raw, rgba);
    Frame::Content sent, plain;
    sent.depth = plain.depth = image.depth;
    sent.raw = raw, plain.colour = rgba;
    const CameraInfo sender = sends(raw.format, camera);
    const auto masks = masksOf(scene, sender, sent);
    CHECK(masks == masksOf(scene, camera, plain));
    CHECK(masks == masksOf(scene, sender, sent, [&](Plan& plan) {
              forGpu(plan);
              plan.keepDepth = camera.depth.width % 4 == 0;
          }));
    CHECK(countOf(masks) > camera.depth.pixels() / 8);
}

void checkAllFormats(const Scene& scene, const CameraInfo& camera) {
    for (const RawColour& raw : formatsOf(camera.colour.width, camera.colour.height)) {
        checkSame(scene, camera, raw);
    }
}

} // namespace

TEST_CASE("Classes from every format equal the twin's at widths that are and are not multiples of four") {
    for (const ColourFormat format : {ColourFormat::Yuyv, ColourFormat::Uyvy, ColourFormat::Rgb,
                                      ColourFormat::Bgr, ColourFormat::Planes, ColourFormat::JpegPlanes}) {
        CAPTURE(nameOf(format));
        for (const glm::uvec2 size :
             {glm::uvec2(1, 1), glm::uvec2(63, 33), glm::uvec2(64, 47), glm::uvec2(130, 35)}) {
            CAPTURE(size.x);
            const CameraInfo camera = sends(format, pinholeCamera(size.x, size.y));
            CloudRig rig(classesScene(8), camera);
            rig.run(stressImage(camera, size.x));
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
}

TEST_CASE("Colour is uploaded as the camera sends it, if a class uses it") {
    const CameraInfo camera = pinholeCamera(64, 48);
    Scene scene = gates();
    const auto itemOf = [&](ColourFormat format) {
        const Plan plan = makePlan(scene, sends(format, camera), 1, vulkan().device.facts());
        return *std::ranges::find(plan.items, "colour upload", &Plan::Item::name);
    };
    constexpr uint64_t kPixels = 64 * 48;
    CHECK(itemOf(ColourFormat::Rgba).bytes == 4 * kPixels);
    CHECK(itemOf(ColourFormat::Rgb).bytes == 3 * kPixels);
    CHECK(itemOf(ColourFormat::Uyvy).bytes == 2 * kPixels);
    CHECK(itemOf(ColourFormat::Planes).bytes == 3 * kPixels / 2);
    CHECK(itemOf(ColourFormat::JpegPlanes).bytes == 3 * kPixels);
    CHECK(itemOf(ColourFormat::Bgr).why.find("; BGR, unconverted") != std::string::npos);
    scene = plainScene();
    CHECK(itemOf(ColourFormat::Yuyv).bytes == 0);
}

TEST_CASE("Every image has the classes of its host-unpacked colours, to the last bit") {
    checkAllFormats(gates(), pinholeCamera(320, 241)); // four pixels per fetch
    checkAllFormats(gates(), pinholeCamera(161, 121)); // one
    checkSame(gates(), pinholeCamera(640, 480), {ColourFormat::Yuyv, 640, 480, {}});
}

TEST_CASE("Colours looked up in another camera's image equal those of the unpacked image") {
    const CameraInfo camera = secondCamera(pinholeCamera(160, 120));
    checkAllFormats(gates(), camera);
}

TEST_CASE("Colours of every format are corrected for water like others") {
    Scene scene = gates();
    scene.attenuation = dvec3(0.6, 0.15, 0.1);
    checkSame(scene, pinholeCamera(322, 241), {ColourFormat::Yuyv, 322, 241, {}});
    checkSame(scene, pinholeCamera(322, 241), {ColourFormat::Rgb, 322, 241, {}});
}

TEST_CASE("Each frame of a motion JPEG may have its own sampling") {
    const CameraInfo camera = sends(ColourFormat::JpegPlanes, pinholeCamera(64, 48));
    const Image image = drawnImage(camera, [](int, int) { return 0.9; });
    CloudRig rig(gates(), camera);
    uint32_t number = 0;
    for (RawColour raw : formatsOf(64, 48)) {
        if (raw.format != ColourFormat::JpegPlanes) {
            continue;
        }
        const std::vector<std::byte> bytes = anyBytes(raw.needed());
        raw.bytes = bytes;
        Frame::Content content;
        content.depth = image.depth, content.raw = raw;
        content.sourceNumber = ++number;
        rig.cycle().process(Frame(content, nullptr));
        CHECK(rig.masks() == masksOf(gates(), camera, content));
    }
    CHECK(number == 6);
}

TEST_CASE("A frame without the announced format or with a missing row is rejected") {
    const CameraInfo camera = sends(ColourFormat::Yuyv, pinholeCamera(64, 48));
    CloudRig rig(classesScene(3), camera);
    const Image image = stressImage(camera, 1);
    const std::vector<std::byte> bytes = anyBytes(2 * 64 * 48);
    Frame::Content content;
    content.depth = image.depth, content.colour = image.colour;
    CHECK_THROWS_WITH_AS(rig.cycle().process(Frame(content, nullptr)),
                         "frame: YUYV image of 0 bytes, needs 6144", Error);
    content.raw = {ColourFormat::Yuyv, 64, 48, std::span(bytes).first(2 * 64 * 47)};
    CHECK_THROWS_WITH_AS(rig.cycle().process(Frame(content, nullptr)),
                         "frame: YUYV image of 6016 bytes, needs 6144", Error);
    content.raw = {ColourFormat::Uyvy, 64, 48, bytes};
    CHECK_THROWS_WITH_AS(rig.cycle().process(Frame(content, nullptr)),
                         "frame: YUYV image of 0 bytes, needs 6144", Error);
}

TEST_CASE("Colour in whole pages is read in place and gives the results of a copy") {
    const CameraInfo plain = pinholeCamera(205, 117);
    const Image image = drawnImage(plain, [](int, int) { return 0.9; });
    for (RawColour raw : formatsOf(205, 117)) {
        CAPTURE(nameOf(raw.format));
        const CameraInfo camera = sends(raw.format, plain);
        const std::vector<std::byte> bytes = anyBytes(raw.needed());
        FrameSlots slots(camera.slotPixels(), true, 1);
        FrameSlot& slot = *slots.acquire();
        std::ranges::copy(image.depth, slot.depth().begin());
        std::ranges::copy(bytes, slot.colourBytes().begin());
        Frame::Content content;
        content.depth = slot.depth().first(camera.depth.pixels()), content.raw = raw;
        content.setColourBytes(slot.colourBytes().first(bytes.size()));
        CloudRig rig(gates(), camera);
        const FrameReport report = rig.cycle().process(slot.lend(content));
        CHECK(report.inPlace == rig.plan().inPlace);
        cloud::UploadSlots uploads(vulkan().device, rig.plan(), camera);
        const auto choice = uploads.choose(slot.lend(content));
        CHECK(uploads[choice.slot].colour.imported() == rig.plan().inPlace);
        const auto inPlace = rig.masks();
        content.depth = image.depth, content.raw.bytes = bytes;
        CHECK(inPlace == masksOf(gates(), camera, content));
        CHECK(countOf(inPlace) > camera.depth.pixels() / 4);
    }
}
