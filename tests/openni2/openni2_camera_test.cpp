// SPDX-License-Identifier: Apache-2.0
// The OpenNI2 camera on the real library: a live device of a test driver, and .oni files of the library's own
// recorder.
#include "devices/openni2/openni2_camera.h"

#include "devices/openni2/open_openni2.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;

namespace {

const testing::ScratchFolder kFolder;

// True if every pixel belongs to one drawn frame; `n` receives its number.
bool isDrawn(const Frame& frame, int& n) {
    n = frame->depth[0] - 1000;
    const std::vector<uint32_t> colours = coloursOf(*frame);
    for (uint32_t v = 0; v < 24; ++v) {
        for (uint32_t u = 0; u < 32; ++u) {
            const size_t i = v * 32 + u;
            const uint32_t colour = 0xff000000u | static_cast<uint32_t>(n & 255) << 16 | v << 8 | u;
            if (frame->depth[i] != 1000 + 40 * v + u + static_cast<uint32_t>(n) ||
                (!colours.empty() && colours[i] != colour)) {
                return false;
            }
        }
    }
    return true;
}

// Returns the number of depth frames in the file. The library drops frames that are not written when it
// stops, on a busy machine most of them.
int record(const char* uri, const std::string& file, int images, bool colour) {
    REQUIRE(openni::OpenNI::initialize() == openni::STATUS_OK);
    {
        openni::Device device;
        openni::VideoStream depth, rgb;
        openni::Recorder recorder;
        REQUIRE(device.open(uri) == openni::STATUS_OK);
        device.setImageRegistrationMode(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR);
        REQUIRE(depth.create(device, openni::SENSOR_DEPTH) == openni::STATUS_OK);
        REQUIRE(rgb.create(device, openni::SENSOR_COLOR) == openni::STATUS_OK);
        REQUIRE(recorder.create(file.c_str()) == openni::STATUS_OK);
        REQUIRE(recorder.attach(depth) == openni::STATUS_OK);
        if (colour) {
            REQUIRE(recorder.attach(rgb) == openni::STATUS_OK);
        }
        REQUIRE(recorder.start() == openni::STATUS_OK);
        depth.start();
        rgb.start();
        openni::VideoFrameRef frame;
        for (int i = 0; i < images; ++i) {
            depth.readFrame(&frame);
            rgb.readFrame(&frame);
        }
        recorder.stop();
        depth.stop();
        rgb.stop();
        recorder.destroy();
        frame.release();
        depth.destroy();
        rgb.destroy();
        device.close();
    }
    int kept = 0;
    {
        openni::Device player;
        openni::VideoStream depth;
        if (player.open(file.c_str()) == openni::STATUS_OK) {
            REQUIRE(depth.create(player, openni::SENSOR_DEPTH) == openni::STATUS_OK);
            kept = player.getPlaybackControl()->getNumberOfFrames(depth);
            depth.destroy();
        }
    }
    openni::OpenNI::shutdown();
    return kept;
}

std::string recorded(const char* uri, int images, bool colour) {
    const std::string file = (kFolder / (std::string(uri) + (colour ? "" : "-depth") + ".oni")).string();
    for (int reads = images; record(uri, file, reads, colour) < images; reads *= 2) {
        REQUIRE(reads < 500);
    }
    return file;
}

std::string refusal(const std::string& source) {
    return testing::refusalOf([&] { openOpenNi2(source); });
}

} // namespace

TEST_CASE("A live device gives depth with its own colour, registered, with the lens of its field of view") {
    for (const char* uri : {"fathom-test", "fathom-test-mirrored"}) {
        CAPTURE(uri);
        const auto camera = openOpenNi2(std::string("openni2:") + uri);
        const CameraInfo& info = camera->info();
        CHECK(camera->live());
        CHECK(info.hasColour);
        CHECK(info.registered);
        CHECK(info.metresPerUnit == 0.001);
        CHECK(info.depth.fx == doctest::Approx(16.0 / std::tan(0.5)));
        CHECK(info.depth.fy == doctest::Approx(12.0 / std::tan(0.4)));
        CHECK(camera->framePeriod() == doctest::Approx(1.0 / 30.0));
        int before = 0;
        for (int i = 0; i < 5; ++i) {
            const auto frame = camera->next();
            REQUIRE(frame);
            int n = 0;
            CHECK(isDrawn(*frame, n));
            CHECK((*frame)->raw.format == ColourFormat::Rgb); // not converted
            CHECK(n > before);
            before = n;
        }
    }
}

TEST_CASE("A silent device is reported as lost") {
    const auto camera = openOpenNi2("openni2:fathom-test-silent");
    CHECK_THROWS_AS(
        [&] {
            for (int i = 0; i < 9; ++i) {
                camera->next();
            }
        }(),
        DeviceLost);
}

TEST_CASE("A device whose depth and colour never belong together is reported as lost, and each cause once") {
    const auto camera = openOpenNi2("openni2:fathom-test-apart");
    CHECK_THROWS_AS(camera->next(), DeviceLost);
    CHECK(camera->skipped() > 0);
}

namespace {

// Checks every frame until the end: as drawn, and later than the previous one. Returns their number.
int readWhole(Camera& camera) {
    int count = 0, before = 0;
    double stamp = -1.0;
    while (const auto frame = camera.next()) {
        int n = 0;
        CHECK(isDrawn(*frame, n));
        CHECK(n > before);
        CHECK((*frame)->captureTime > stamp);
        before = n;
        stamp = (*frame)->captureTime;
        ++count;
    }
    CHECK_FALSE(camera.next());
    MESSAGE("read ", count, " frames");
    return count;
}

} // namespace

TEST_CASE("An .oni file gives the recorded device's frames bit by bit, and ends") {
    for (const bool colour : {false, true}) {
        CAPTURE(colour);
        int count = 0;
        // On a busy machine the library's recorder drops frames, colour first.
        for (int asked = 6; count < 6 && asked <= 96; asked *= 2) {
            const auto camera = openOpenNi2(recorded("fathom-test", asked, colour) + ",registered=yes");
            CHECK_FALSE(camera->live());
            CHECK(camera->info().hasColour == colour);
            CHECK(camera->info().depth.fx == doctest::Approx(16.0 / std::tan(0.5)));
            count = readWhole(*camera);
        }
        CHECK(count >= 6);
        CHECK_FALSE(openOpenNi2(recorded("fathom-test", 2, colour))->info().hasColour); // unless it is said
    }
}

TEST_CASE("A missing file, a file that is not a recording, and an unknown lens are rejected in one line") {
    CHECK(refusal("openni2:nowhere").find("nowhere: device") != std::string::npos);
    CHECK(refusal("/none/x.oni").find("/none/x.oni: device") != std::string::npos);
    CHECK(refusal("openni2:fathom-test,focus=3").find("focus=3 (allowed: intrinsics=FILE, registered=yes)") !=
          std::string::npos);
    CHECK(refusal("openni2:fathom-test-plain").find("field of view: unknown") != std::string::npos);
    const auto lens = [](int width) {
        const std::string file = (kFolder / "lens.json").string();
        std::ofstream(file) << "{\"width\": " << width
                            << ", \"height\": 24, \"fx\": 30, \"fy\": 31, \"cx\": 16, \"cy\": 12, "
                               "\"depth_scale_m_per_unit\": 0.001}";
        return file;
    };
    CHECK(refusal("openni2:fathom-test-plain,intrinsics=" + lens(33)).find("33x24") != std::string::npos);
    const auto camera = openOpenNi2("openni2:fathom-test-plain,intrinsics=" + lens(32));
    CHECK(camera->info().depth.fy == 31.0);
    CHECK_FALSE(camera->info().hasColour); // not registered
    const auto frame = camera->next();
    REQUIRE(frame);
    CHECK((*frame)->colourBytes().empty());
}

TEST_CASE(
    "A USB camera known to a driver is listed with its sizes, and one without a driver with the reason") {
    const auto refusalFor = [](uint16_t vendor, uint16_t product) {
        return testing::refusalOf([&] { openNi2Offer(vendor, product); });
    };
    CHECK(refusalFor(0x1d27, 0x0601).find("driver: no driver knows this camera") != std::string::npos);
    ::setenv("FATHOM_TEST_PLUGGED", "1", 1);
    CHECK(openNi2Offer(0x1d27, 0x0601) == "depth 32x24, colour 32x24; --source openni2:fathom-test");
    CHECK(refusalFor(0x1d27, 0x0609).find("no driver knows") != std::string::npos); // another one
    ::unsetenv("FATHOM_TEST_PLUGGED");
}

TEST_CASE("OpenNI2 requests are distinguished from others") {
    for (const char* yes : {"openni2", "openni2:2bc5/0401@1/2", "a/b.oni", "x.oni,intrinsics=l.json"}) {
        CHECK_MESSAGE(isOpenNi2Request(yes), yes);
    }
    for (const char* no : {"openni", "v4l2:auto", "a/b.bag", "oni", "rec,intrinsics=x.oni"}) {
        CHECK_FALSE_MESSAGE(isOpenNi2Request(no), no);
    }
}
