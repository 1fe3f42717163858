// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/compressed_depth.h"
#include "devices/bag/image_pixels.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/encoded_images.h"
#include "tests/devices/recorded_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

ros::Image rawImage(const std::string& encoding, const std::string& pixels, uint32_t rows = kDown) {
    ros::Image image;
    image.encoding = encoding;
    image.width = kAcross;
    image.height = kDown;
    image.step = static_cast<uint32_t>(pixels.size()) / rows;
    image.data = {reinterpret_cast<const uint8_t*>(pixels.data()), pixels.size()};
    return image;
}

std::string repeated(const std::string& bytes, uint32_t count) {
    std::string all;
    for (uint32_t i = 0; i < count; ++i) {
        all += bytes;
    }
    return all;
}

std::string pngOf(const TemporaryFolder& folder, bool depth, uint16_t value) {
    if (depth) {
        writeDepth(folder.path() / "x.png", kAcross, kDown, value);
    } else {
        writeColour(folder.path() / "x.png", kAcross, kDown, 255, 0, 0);
    }
    return folder.read("x.png");
}

std::vector<uint16_t> depthsOf(const ros::Image& image, double metresPerUnit = 0.0001) {
    std::vector<uint16_t> out(kAcross * kDown);
    uint64_t beyond = 0;
    CHECK(ros::content(image) == ros::Content::Depth);
    CHECK(ros::depthRows(image, metresPerUnit, out, beyond) == "");
    CHECK(beyond == 0);
    return out;
}

} // namespace

TEST_CASE("A red image is red in every colour encoding that is read") {
    constexpr uint32_t kAll = kAcross * kDown;
    const std::string kZero(1, '\0'), kFull = "\xff", kWide = std::string("\x12\xff", 2), kNone(2, '\0');
    checkRed(rawImage("rgb8", repeated(kFull + kZero + kZero, kAll)), "rgb8");
    checkRed(rawImage("bgr8", repeated(kZero + kZero + kFull, kAll)), "bgr8");
    checkRed(rawImage("8UC3", repeated(kZero + kZero + kFull, kAll)), "8UC3");
    checkRed(rawImage("8UC4", repeated(kZero + kZero + kFull + kZero, kAll)), "8UC4");
    checkRed(rawImage("rgba8", repeated(kFull + kZero + kZero + kZero, kAll)), "rgba8");
    checkRed(rawImage("bgra8", repeated(kZero + kZero + kFull + kZero, kAll)), "bgra8");
    checkRed(rawImage("rgb16", repeated(kWide + kNone + kNone, kAll)), "rgb16");
    checkRed(rawImage("bgr16", repeated(kNone + kNone + kWide, kAll)), "bgr16");
    checkRed(rawImage("rgba16", repeated(kWide + kNone + kNone + kWide, kAll)), "rgba16");
    checkRed(rawImage("bgra16", repeated(kNone + kNone + kWide + kWide, kAll)), "bgra16");
    // BT.601, limited range: red is Y 81, U 90, V 240.
    checkRed(rawImage("yuv422", repeated("\x5a\x51\xf0\x51", kAll / 2)), "yuv422");
    checkRed(rawImage("uyvy", repeated("\x5a\x51\xf0\x51", kAll / 2)), "uyvy");
    checkRed(rawImage("yuv422_yuy2", repeated("\x51\x5a\x51\xf0", kAll / 2)), "yuv422_yuy2");
    checkRed(rawImage("YUYV", repeated("\x51\x5a\x51\xf0", kAll / 2)), "YUYV");
    checkRed(rawImage("nv12", repeated("\x51", kAll) + repeated("\x5a\xf0", kAll / 4), kDown * 3 / 2),
             "nv12");
    checkRed(rawImage("nv21", repeated("\x51", kAll) + repeated("\xf0\x5a", kAll / 4), kDown * 3 / 2),
             "nv21");
    checkRed(rawImage("yuy2", repeated("\x51\x5a\x51\xf0", kAll / 2)), "yuy2");
    const std::string luma = repeated("\x51", kAll), blue = repeated("\x5a", kAll / 4),
                      red = repeated("\xf0", kAll / 4);
    checkRed(rawImage("i420", luma + blue + red, kDown * 3 / 2), "i420");
    checkRed(rawImage("yv12", luma + red + blue, kDown * 3 / 2), "yv12");
    checkRed(rawImage("i420", luma + blue + red, kDown), "i420, rows that count all planes");
    const char* const kOrders[] = {"rggb", "grbg", "gbrg", "bggr"}; // by the place of red
    for (uint32_t at = 0; at < 4; ++at) {
        checkRed(rawImage(std::string("bayer_") + kOrders[at] + "8", mosaic(at, 1)), kOrders[at]);
        checkRed(rawImage(std::string("bayer_") + kOrders[at] + "16", mosaic(at, 2)), kOrders[at]);
    }
    const std::string jpeg = encodedJpeg(255, 0, 0);
    checkRed(packedImage("rgb8; jpeg compressed bgr8", jpeg), "JPEG");
    checkRed(packedImage("jpeg", jpeg), "bare JPEG");
    const std::string mjpg =
        imageMessage(1.0, {.encoding = "mjpg", .width = kAcross, .height = kDown, .pixels = jpeg});
    checkRed(ros::image({{reinterpret_cast<const uint8_t*>(mjpg.data()), mjpg.size()}, false}), "mjpg");
    const TemporaryFolder folder;
    const std::string png = pngOf(folder, false, 0);
    checkRed(packedImage("bgr8; png compressed bgr8", png), "PNG");
}

TEST_CASE("Big-endian images give the same depth, metres and colours as little-endian ones") {
    constexpr uint32_t kAll = kAcross * kDown;
    const std::string units = repeated(std::string("\x03\xe8", 2), kAll); // 1000
    ros::Image depth = rawImage("16UC1", units);
    depth.bigEndian = true;
    CHECK(depthsOf(depth) == std::vector<uint16_t>(kAll, 1000));
    const std::string metres = repeated(std::string("\x3f\x80\x00\x00", 4), kAll); // 1.0f
    ros::Image reals = rawImage("32FC1", metres);
    reals.bigEndian = true;
    CHECK(depthsOf(reals) == std::vector<uint16_t>(kAll, 10000));
    CHECK(ros::valueSpan(reals).farthest == 1.0);
    const std::string kWide = std::string("\xff\x12", 2), kNone(2, '\0');
    for (const auto& [encoding, pixel] :
         {std::pair("rgb16", kWide + kNone + kNone), std::pair("bgr16", kNone + kNone + kWide),
          std::pair("bgra16", kNone + kNone + kWide + kWide)}) {
        const std::string pixels = repeated(pixel, kAll);
        ros::Image image = rawImage(encoding, pixels);
        image.bigEndian = true;
        checkRed(image, encoding);
    }
    std::string cells = mosaic(0, 2);
    for (size_t i = 0; i < cells.size(); i += 2) {
        std::swap(cells[i], cells[i + 1]);
    }
    ros::Image bayer = rawImage("bayer_rggb16", cells);
    bayer.bigEndian = true;
    checkRed(bayer, "bayer_rggb16");
    const std::string bytes = repeated(std::string("\xff\x00\x00", 3), kAll);
    ros::Image narrow = rawImage("rgb8", bytes); // bytes have no order
    narrow.bigEndian = true;
    checkRed(narrow, "rgb8");
}

TEST_CASE("Too few bytes, or rows that are too short, are a fault in every encoding") {
    std::vector<uint32_t> out(kAcross * kDown);
    for (const char* encoding : {"rgb8", "rgb16", "yuv422", "nv12", "nv21", "i420", "yv12", "bayer_rggb8",
                                 "bayer_gbrg16", "mono8"}) {
        const std::string pixels(kAcross * 8 * kDown, '\1');
        ros::Image image = rawImage(encoding, pixels);
        image.data = image.data.first(image.data.size() / 2);
        CHECK_FALSE(readRows(image, out).empty());
        image = rawImage(encoding, pixels);
        image.step = kAcross - 1;
        CHECK_FALSE(readRows(image, out).empty());
    }
}

TEST_CASE("Compressed depth as PNG and RVL gives the same values as plain depth") {
    const TemporaryFolder folder;
    const std::string head(12, '\0'), png = pngOf(folder, true, 3124);
    CHECK(depthsOf(packedImage("16UC1; compressedDepth png", head + png))[kCentre] == 3124);
    CHECK(depthsOf(packedImage("16UC1; compressedDepth", head + png))[kCentre] == 3124);
    CHECK(depthsOf(packedImage("16UC1; png compressed ", png))[kCentre] == 3124);
    // RVL by the paper: no zeros, 48 values; +3124, then steps of 0. Nibbles of 3 bits, the fourth says more.
    std::string nibbles = "0"
                          "8"
                          "6"; // 48 = 000 110, least significant group first
    for (uint32_t value = 2 * 3124; value > 0; value >>= 3) {
        nibbles += "0123456789abcdef"[(value & 7) | (value > 7 ? 8 : 0)];
    }
    nibbles += std::string(47, '0');
    nibbles.resize((nibbles.size() + 7) / 8 * 8, '0');
    std::string rvl = raw(kAcross) + raw(kDown);
    for (size_t i = 0; i < nibbles.size(); i += 8) {
        rvl += raw(static_cast<uint32_t>(std::stoul(nibbles.substr(i, 8), nullptr, 16)));
    }
    const auto values = depthsOf(packedImage("16UC1; compressedDepth rvl", head + rvl));
    CHECK(values.front() == 3124);
    CHECK(values.back() == 3124);
    CHECK(depthsOf(rawImage("rvl", rvl.substr(8))) == values); // without the size, as the Orbbec SDK has it
    std::vector<uint16_t> out(kAcross * kDown);
    uint64_t beyond = 0;
    const std::string cut = head + rvl.substr(0, rvl.size() - 8);
    CHECK_FALSE(ros::depthRows(packedImage("16UC1; compressedDepth rvl", cut), 0.001, out, beyond).empty());
}

TEST_CASE("Compressed depth is recognised without its format, and without its header") {
    const TemporaryFolder folder;
    const std::string png = pngOf(folder, true, 3124), plain(12, '\0'),
                      quantised = raw(uint32_t{1}) + raw(10100.0f) + raw(-1009.0f);
    CHECK(depthsOf(packedImage("png", plain + png))[kCentre] == 3124);
    CHECK(depthsOf(packedImage("16UC1; compressedDepth png", png))[kCentre] == 3124);
    CHECK(depthsOf(packedImage("16UC1; compressedDepth png", quantised + png))[kCentre] == 3124);
    const std::string metres = pngOf(folder, true, 19191); // 10100 / 0.5 - 1009
    CHECK(ros::holdsMetres(packedImage("png", quantised + metres)));
    CHECK(depthsOf(packedImage("png", quantised + metres))[kCentre] == 5000);
    std::vector<uint16_t> out(kAcross * kDown);
    uint64_t beyond = 0;
    const std::string fault =
        ros::depthRows(packedImage("32FC1; compressedDepth png", png), 0.001, out, beyond);
    CHECK(fault.find("without the header") != std::string::npos);
    CHECK(ros::content(packedImage("png", pngOf(folder, false, 0))) == ros::Content::Colour);
    CHECK_FALSE(ros::holdsMetres(packedImage("compressedDepth rvl", "cut off")));
}

TEST_CASE("Compressed depth of metres is inverse depth with its two factors") {
    const TemporaryFolder folder;
    // stored = A / z + B
    constexpr float kA = 1000.0f, kB = 20.0f;
    const std::string head = raw(uint32_t{1}) + raw(kA) + raw(kB);
    const std::string png = pngOf(folder, true, 2020); // 1000 / 0.5 + 20
    CHECK(depthsOf(packedImage("32FC1; compressedDepth png", head + png))[kCentre] == 5000);
    const std::string none = pngOf(folder, true, 0);
    CHECK(depthsOf(packedImage("32FC1; compressedDepth png", head + none))[kCentre] == 0);
}
