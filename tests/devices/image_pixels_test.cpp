// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/compressed_depth.h"
#include "devices/bag/image_pixels.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/recorded_folder.h"

#include <doctest/doctest.h>
#include <turbojpeg.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kAcross = 8, kDown = 6, kCentre = 2 * kAcross + 3;

ros::Image rawImage(const std::string& encoding, const std::string& pixels, uint32_t rows = kDown) {
    ros::Image image;
    image.encoding = encoding;
    image.width = kAcross;
    image.height = kDown;
    image.step = static_cast<uint32_t>(pixels.size()) / rows;
    image.data = {reinterpret_cast<const uint8_t*>(pixels.data()), pixels.size()};
    return image;
}

ros::Image packedImage(const std::string& format, const std::string& bytes) {
    ros::Image image;
    image.compressed = true;
    image.format = format;
    image.encoding = format.substr(0, format.find(';'));
    image.data = {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
    return image;
}

// Red, by less than 6 levels of each channel.
bool isRed(uint32_t pixel) {
    return (pixel & 0xff) > 244 && (pixel >> 8 & 0xff) < 6 && (pixel >> 16 & 0xff) < 6 && pixel >> 24 == 255;
}

// As R8 G8 B8 A8.
std::string readRows(const ros::Image& image, std::vector<uint32_t>& out) {
    RawColour raw;
    std::vector<uint32_t> memory(out.size());
    const std::string fault = ros::colourRows(image, memory, raw);
    if (fault.empty()) {
        CHECK(raw.format == ros::colourFormat(image));
        raw.format == ColourFormat::Rgba ? out.swap(memory) : unpackColour(raw, out);
    }
    return fault;
}

void checkRed(const ros::Image& image, const std::string& name) {
    std::vector<uint32_t> out(kAcross * kDown);
    CHECK_MESSAGE(ros::content(image) == ros::Content::Colour, name);
    CHECK_MESSAGE(readRows(image, out) == "", name);
    CHECK_MESSAGE(isRed(out[0]), name);
    CHECK_MESSAGE(isRed(out[kCentre]), name);
    CHECK_MESSAGE(isRed(out.back()), name);
}

std::string repeated(const std::string& bytes, uint32_t count) {
    std::string all;
    for (uint32_t i = 0; i < count; ++i) {
        all += bytes;
    }
    return all;
}

// Red cells of 2 x 2 pixels, `at` the place of red.
std::string mosaic(uint32_t at, uint32_t bytes) {
    std::string all;
    for (uint32_t i = 0; i < kAcross * kDown; ++i) {
        const bool red = (i / kAcross % 2) * 2 + i % 2 == at;
        all += std::string(bytes - 1, '\0') + (red ? '\xff' : '\0');
    }
    return all;
}

std::string jpegOf(const std::string& pixels, bool grey) {
    tjhandle encoder = tjInitCompress();
    unsigned char* made = nullptr;
    unsigned long size = 0;
    tjCompress2(encoder, reinterpret_cast<const unsigned char*>(pixels.data()), kAcross, 0, kDown,
                grey ? TJPF_GRAY : TJPF_RGB, &made, &size, grey ? TJSAMP_GRAY : TJSAMP_444, 100, 0);
    std::string bytes(reinterpret_cast<const char*>(made), size);
    tjFree(made);
    tjDestroy(encoder);
    return bytes;
}

std::string jpegOf(uint8_t r, uint8_t g, uint8_t b) {
    return jpegOf(filledColour(r, g, b, kAcross * kDown), false);
}

// Grey, of 8 or 16 bits.
std::string greyPng(const TemporaryFolder& folder, const std::string& pixels, int bits) {
    writePng(folder.path() / "grey.png", kAcross, kDown, bits, 0, {pixels.begin(), pixels.end()});
    return folder.read("grey.png");
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
    const std::string jpeg = jpegOf(255, 0, 0);
    checkRed(packedImage("rgb8; jpeg compressed bgr8", jpeg), "JPEG");
    checkRed(packedImage("jpeg", jpeg), "bare JPEG");
    const std::string mjpg =
        imageMessage(1.0, {.encoding = "mjpg", .width = kAcross, .height = kDown, .pixels = jpeg});
    checkRed(ros::image({{reinterpret_cast<const uint8_t*>(mjpg.data()), mjpg.size()}, false}), "mjpg");
    const TemporaryFolder folder;
    const std::string png = pngOf(folder, false, 0);
    checkRed(packedImage("bgr8; png compressed bgr8", png), "PNG");
}

TEST_CASE("A mosaic that was compressed as one component is read in colour, and other such images are grey") {
    const TemporaryFolder folder;
    const char* const kOrders[] = {"rggb", "grbg", "gbrg", "bggr"}; // by the place of red
    for (uint32_t at = 0; at < 4; ++at) {
        const std::string encoding = std::string("bayer_") + kOrders[at], cells = mosaic(at, 1);
        std::string wide; // as PNG has it: the high byte first
        for (const char cell : cells) {
            wide += std::string(1, cell) + '\x12';
        }
        checkRed(packedImage(encoding + "8; jpeg compressed ", jpegOf(cells, true)), encoding + " JPEG");
        checkRed(packedImage(encoding + "8; png compressed ", greyPng(folder, cells, 8)), encoding + " PNG");
        checkRed(packedImage(encoding + "16; png compressed ", greyPng(folder, wide, 16)),
                 encoding + "16 PNG");
    }
    checkRed(packedImage("bayer_rggb8; jpeg compressed bgr8", jpegOf(255, 0, 0)), "converted before");
    const std::string grey(kAcross * kDown, '\x50');
    for (const char* format : {"jpeg", "mono8; jpeg compressed ", "rgb8; jpeg compressed bgr8"}) {
        CHECK(ros::content(packedImage(format, jpegOf(grey, true))) == ros::Content::Grey);
    }
    CHECK(ros::content(packedImage("mono16; png compressed ", greyPng(folder, grey + grey, 16))) ==
          ros::Content::Depth);
    const std::string cut = jpegOf(mosaic(0, 1), true);
    std::vector<uint32_t> out(kAcross * kDown);
    const std::string head = cut.substr(0, cut.size() / 2);
    CHECK_FALSE(readRows(packedImage("bayer_rggb8; jpeg compressed ", head), out).empty());
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
