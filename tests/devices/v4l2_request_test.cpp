// SPDX-License-Identifier: Apache-2.0
// What a user may ask of a live camera; RealSense tables and lenses without one.
#include "devices/v4l2/camera_request.h"
#include "devices/v4l2/extension_unit.h"
#include "devices/v4l2/inverse_distortion.h"
#include "devices/v4l2/realsense_tables.h"
#include "engine/types/error.h"
#include "tests/support/refusal.h"

#include <cmath>
#include <cstring>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

std::string refusal(const std::string& text) {
    return testing::refusalOf([&] { parseCameraRequest(text); });
}

} // namespace

TEST_CASE("A camera request names device, sizes, formats, rate and a number of frames") {
    const CameraRequest request =
        parseCameraRequest("v4l2:/dev/video2,colour=/dev/video4,size=848x480,colour_size=1280x720,rate=90,"
                           "colour_rate=15,format=Z16,colour_format=MJPG,intrinsics=a/b.json,frames=12");
    CHECK(request.device == "/dev/video2");
    CHECK(request.colour == "/dev/video4");
    CHECK(*request.size == VideoSize{848, 480});
    CHECK(*request.colourSize == VideoSize{1280, 720});
    CHECK(request.rate == 90.0);
    CHECK(request.colourRate == 15.0);
    CHECK(request.format == fourccOf("Z16 "));
    CHECK(request.colourFormat == fourccOf("MJPG"));
    CHECK(request.intrinsics == "a/b.json");
    CHECK(request.frames == 12);
    CHECK(parseCameraRequest("v4l2").device == "auto");
    CHECK(parseCameraRequest("/dev/video0").device == "/dev/video0"); // as a scene has it
    CHECK(isCameraRequest("v4l2:auto"));
    CHECK_FALSE(isCameraRequest("recordings/v4l2"));
}

TEST_CASE("An invalid camera request is rejected in one line with what is allowed") {
    for (const char* text :
         {"v4l2:", "v4l2:video0", "v4l2:auto,", "v4l2:auto,/dev/video1", "v4l2:auto,speed=3",
          "v4l2:auto,size=640", "v4l2:auto,size=0x480", "v4l2:auto,size=640x480x2", "v4l2:auto,size=9999x480",
          "v4l2:auto,rate=0", "v4l2:auto,rate=nan", "v4l2:auto,colour_rate=0", "v4l2:auto,frames=0",
          "v4l2:auto,frames=-1", "v4l2:auto,format=TOOLONG"}) {
        const std::string said = refusal(text);
        CHECK_MESSAGE(said.find("(allowed: ") != std::string::npos, text);
        CHECK(said.find('\n') == std::string::npos);
    }
}

TEST_CASE(
    "An extension unit is found by its GUID among all descriptors, and damaged descriptors end the search") {
    UnitGuid guid{};
    for (size_t i = 0; i < guid.size(); ++i) {
        guid[i] = static_cast<uint8_t>(i + 1);
    }
    std::vector<uint8_t> bytes{9, 2, 0, 0, 1, 1, 0, 0, 0};
    std::vector<uint8_t> unit{26, 0x24, 6, 7};
    unit.insert(unit.end(), guid.begin(), guid.end());
    unit.resize(26);
    CHECK_FALSE(unitOf(guid, bytes));
    bytes.insert(bytes.end(), unit.begin(), unit.end());
    CHECK(unitOf(guid, bytes) == uint8_t{7});
    CHECK_FALSE(unitOf(guid, std::span(bytes).first(20))); // cut off
    bytes[0] = 0;
    CHECK_FALSE(unitOf(guid, bytes)); // a length of zero would never end
    CHECK_FALSE(unitOf(guid, {}));
}

TEST_CASE("A RealSense table of a wrong length, number or checksum is refused") {
    std::vector<uint8_t> table(16 + 560, 0);
    table[2] = 25;
    table[4] = 560 & 255;
    table[5] = 560 >> 8;
    const auto crc = realsense::crc32(std::span(table).subspan(16));
    for (size_t i = 0; i < 4; ++i) {
        table[12 + i] = static_cast<uint8_t>(crc >> (8 * i));
    }
    CHECK_THROWS_AS(realsense::depthLens(table, {640, 480}), Error); // no focal length
    CHECK_THROWS_WITH(realsense::depthLens({}, {640, 480}), doctest::Contains("0 bytes"));
    CHECK_THROWS_WITH(realsense::colourLens(table, {640, 480}), doctest::Contains("names table 25"));
    table[300] ^= 1;
    CHECK_THROWS_WITH(realsense::depthLens(table, {640, 480}), doctest::Contains("wrong checksum"));
    const char* nine = "123456789"; // the check value of CRC-32
    CHECK(realsense::crc32({reinterpret_cast<const uint8_t*>(nine), 9}) == 0xcbf43926u);
}

TEST_CASE("A RealSense colour table whose pose or distortion is no number is rejected") {
    std::vector<uint8_t> table(16 + 240, 0);
    table[2] = 32;
    table[4] = 240;
    const auto put = [&table](size_t at, float value) {
        std::memcpy(table.data() + 16 + at, &value, sizeof value);
    };
    const auto seal = [&table] {
        const uint32_t crc = realsense::crc32(std::span(table).subspan(16));
        std::memcpy(table.data() + 12, &crc, sizeof crc);
    };
    put(0, 1.2f);  // fx
    put(16, 1.6f); // fy
    for (size_t i : {0, 4, 8}) {
        put(168 + 4 * i, 1.0f); // rotation
    }
    seal();
    CHECK(isFinite(realsense::colourLens(table, {640, 480}).colourTdepth));
    for (const size_t at : {size_t{36}, size_t{168}, size_t{204}, size_t{212}}) {
        const std::vector<uint8_t> sound = table;
        put(at, NAN);
        seal();
        CAPTURE(at);
        CHECK_THROWS_WITH(realsense::colourLens(table, {640, 480}), doctest::Contains("is not finite"));
        table = sound;
    }
}

TEST_CASE(
    "The colour lens of a D405 follows the crop of its image processor, checked by hand for each size") {
    std::vector<uint8_t> table(16 + 240, 0);
    table[2] = 32;
    table[4] = 240;
    const auto put = [&table](size_t at, float value) {
        std::memcpy(table.data() + 16 + at, &value, sizeof value);
    };
    put(0, 1.0f); // fx, cx, fy, cy over 1280x720
    put(8, 0.1f);
    put(16, 1.8f);
    put(20, -0.05f);
    const uint32_t calibrated = 1280 | 720u << 16;
    std::memcpy(table.data() + 16 + 128, &calibrated, sizeof calibrated);
    for (size_t i : {0, 4, 8}) {
        put(168 + 4 * i, 1.0f);
    }
    const uint32_t crc = realsense::crc32(std::span(table).subspan(16));
    std::memcpy(table.data() + 12, &crc, sizeof crc);
    struct Case {
        VideoSize size;
        double fx, fy, cx, cy;
    };
    // 640x480: 1280x800 by 0.6015625 is 770 x 481.25; 65 columns are cut per side, 0.625 rows.
    // 848x480: 1280x720 by 2/3 is 853.33 x 480; 2.67 columns are cut per side.
    for (const Case& c :
         {Case{{1280, 720}, 640.0, 648.0, 704.0, 342.0}, Case{{640, 480}, 385.0, 389.8125, 358.5, 229.171875},
          Case{{848, 480}, 426.6666667, 432.0, 466.6666667, 228.0}}) {
        CAPTURE(c.size.width);
        const Intrinsics lens = realsense::colourLens(table, c.size, realsense::ColourSensor::D405).lens;
        CHECK(lens.width == c.size.width);
        CHECK(lens.height == c.size.height);
        CHECK(std::abs(lens.fx - c.fx) < 1e-4);
        CHECK(std::abs(lens.fy - c.fy) < 1e-4);
        CHECK(std::abs(lens.cx - c.cx) < 1e-4);
        CHECK(std::abs(lens.cy - c.cy) < 1e-4);
    }
    // A colour sensor of its own shows 640x480 as the middle of 16:9.
    CHECK(std::abs(realsense::colourLens(table, {640, 480}).lens.fx - 1280.0 / 3.0) < 1e-4);
}

TEST_CASE("Inverse distortion coefficients are converted to forward ones within 0.1 pixels") {
    Intrinsics lens{.width = 1280, .height = 720, .fx = 910, .fy = 909, .cx = 640, .cy = 360};
    const std::array<double, 5> undistorting{-0.05, 0.06, 0.0005, -0.0003, -0.01};
    lens.distortion = forwardDistortion(lens, undistorting);
    double worst = 0.0;
    for (double u = 0; u <= 1280; u += 64) {
        for (double v = 0; v <= 720; v += 48) {
            const double x = (u - lens.cx) / lens.fx, y = (v - lens.cy) / lens.fy, r2 = x * x + y * y;
            const auto& k = undistorting;
            const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
            const dvec3 ray(x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
                            y * radial + 2 * k[3] * x * y + k[2] * (r2 + 2 * y * y), 1.0);
            const glm::dvec2 back = lens.project(ray);
            worst = std::max(worst, std::hypot(back.x - u, back.y - v));
        }
    }
    CHECK(worst < 0.1);
    MESSAGE("largest error " << worst << " pixels");
    CHECK(forwardDistortion(lens, {}) == std::array<double, 5>{});
}
