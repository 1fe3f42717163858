// SPDX-License-Identifier: Apache-2.0
// Cameras that send YUYV, and what is made of their frames.
#include "devices/recorded/recorded_camera.h"
#include "devices/recorded/recording_writer.h"
#include "devices/simulated/analytic_scene.h"
#include "devices/simulated/simulated_camera.h"
#include "devices/water/water_camera.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr uint32_t kWidth = 162, kHeight = 119;

SimulatedCameraOptions optionsOf(bool yuyv, uint32_t width = kWidth) {
    SimulatedCameraOptions options;
    options.width = width, options.height = kHeight, options.frames = 3;
    options.yuyv = yuyv;
    return options;
}

} // namespace

TEST_CASE("A simulated camera can send the same frames as YUYV, at even widths") {
    SimulatedCamera plain(*analyticScene("tank"), optionsOf(false));
    SimulatedCamera packing(*analyticScene("tank"), optionsOf(true));
    CHECK(packing.info().colourFormat == ColourFormat::Yuyv);
    CHECK(plain.info().colourFormat == ColourFormat::Rgba);
    CHECK(packing.info().colourBytes() == 2 * kWidth * kHeight);
    CHECK(plain.info().colourBytes() == 4 * kWidth * kHeight);
    std::vector<uint32_t> words(kWidth * kHeight / 2);
    for (int i = 0; i < 3; ++i) {
        const Frame wanted = *plain.next(), frame = *packing.next();
        packYuyv(wanted->colour, words);
        CHECK(std::ranges::equal(frame->depth, wanted->depth));
        CHECK(std::ranges::equal(frame->raw.bytes, std::as_bytes(std::span(words))));
        CHECK(frame->colour.empty());
        CHECK(frame->colourMemory.get() == frame->raw.bytes.data()); // a device may read it there
    }
    CHECK_THROWS_AS(SimulatedCamera(*analyticScene("tank"), optionsOf(true, 161)), Error);
}

TEST_CASE("A recording of a camera that sends YUYV has the colours that it unpacks to") {
    SimulatedCamera camera(*analyticScene("tank"), optionsOf(true));
    const TemporaryFolder folder;
    std::vector<std::vector<uint32_t>> wanted;
    {
        RecordingWriter writer(folder.path() / "rec", camera.info(), 1);
        while (const auto frame = camera.next()) {
            readColours(**frame, wanted.emplace_back());
            writer.add(*frame);
        }
        writer.finish();
    }
    RecordedCamera recorded(folder.path() / "rec");
    CHECK(recorded.info().colourFormat == ColourFormat::Rgba);
    for (const auto& colours : wanted) {
        const auto frame = recorded.next();
        REQUIRE(frame);
        CHECK(std::ranges::equal((*frame)->colour, colours));
    }
}

TEST_CASE("A flat port corrects depth and passes YUYV through in place") {
    const FlatPort port{0.01, 1.33};
    WaterCamera water(std::make_unique<SimulatedCamera>(*analyticScene("tank"), optionsOf(true)), port, 0.2,
                      4.0);
    SimulatedCamera dry(*analyticScene("tank"), optionsOf(true));
    CHECK(water.info().colourFormat == ColourFormat::Yuyv);
    const Frame frame = *water.next(), wanted = *dry.next();
    CHECK(std::ranges::equal(frame->raw.bytes, wanted->raw.bytes));
    CHECK(frame->colourMemory.get() == frame->raw.bytes.data());
}
