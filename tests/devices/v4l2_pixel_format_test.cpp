// SPDX-License-Identifier: Apache-2.0
// V4L2 pixel layouts, without a camera.
#include "devices/v4l2/pixel_format.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <vector>

using namespace fathom;

namespace {

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
    std::vector<std::byte> bytes;
    for (const int v : values) {
        bytes.push_back(static_cast<std::byte>(v));
    }
    return bytes;
}

std::vector<uint16_t> unpacked(uint32_t fourcc, VideoSize size, uint32_t stride,
                               const std::vector<std::byte>& in) {
    REQUIRE(in.size() >= imageBytes(fourcc, size, stride));
    std::vector<uint16_t> out(size.width * size.height);
    unpackDepth(*depthLayout(fourcc), size, stride, in, out);
    return out;
}

// Returns the fault; else `rgba` has the colours.
std::string coloursFrom(uint32_t fourcc, VideoSize size, uint32_t stride, const std::vector<std::byte>& in,
                        std::vector<uint32_t>& rgba) {
    std::vector<std::byte> copy(mostColourBytes(colourFormatOf(fourcc), size.width, size.height));
    RawColour raw;
    const std::string fault = copyColour(fourcc, size, stride, in, copy, raw);
    if (fault.empty()) {
        CHECK(raw.format == colourFormatOf(fourcc));
        CHECK(raw.bytes.size() >= raw.needed());
        rgba.resize(size_t{size.width} * size.height);
        unpackColour(raw, rgba);
    }
    return fault;
}

} // namespace

TEST_CASE("Sixteen-bit depth is little-endian, and padding between rows is left out") {
    const auto in = bytesOf({1, 2, 3, 4, 99, 99, 5, 6, 255, 255});
    CHECK(unpacked(fourccOf("Z16 "), {2, 2}, 6, in) == std::vector<uint16_t>{0x0201, 0x0403, 0x0605, 0xffff});
}

TEST_CASE("Formats of ten and twelve bits in words keep only their bits") {
    const auto in = bytesOf({0xff, 0xff, 0x34, 0xf2});
    CHECK(unpacked(fourccOf("Y12 "), {2, 1}, 4, in) == std::vector<uint16_t>{0x0fff, 0x0234});
    CHECK(unpacked(fourccOf("Y10 "), {2, 1}, 4, in) == std::vector<uint16_t>{0x03ff, 0x0234});
    CHECK(unpacked(fourccOf("Y16 "), {2, 1}, 4, in) == std::vector<uint16_t>{0xffff, 0xf234});
}

TEST_CASE("Packed ten-bit pixels are read across byte borders, most significant bit first") {
    // 0x3ff, 0x000, 0x2aa, 0x155, then a fifth pixel 0x201 in two more bytes.
    const auto in = bytesOf({0xff, 0xc0, 0x0a, 0xa9, 0x55, 0x80, 0x40});
    CHECK(unpacked(fourccOf("Y10B"), {5, 1}, 7, in) ==
          std::vector<uint16_t>{0x3ff, 0x000, 0x2aa, 0x155, 0x201});
}

TEST_CASE("INZI depth is the second plane, behind the infrared one") {
    const auto in = bytesOf({9, 9, 9, 9, 1, 0, 2, 0});
    CHECK(unpacked(fourccOf("INZI"), {2, 1}, 4, in) == std::vector<uint16_t>{1, 2});
    CHECK(imageBytes(fourccOf("INZI"), {2, 1}, 4) == 8);
}

TEST_CASE(
    "INZI rows have no gaps, although the driver reports a stride of 32 bits per pixel for both planes") {
    const auto in = bytesOf({9, 9, 9, 9, 9, 9, 9, 9, 1, 0, 2, 0, 3, 0, 4, 0}); // 2x2: infrared, then depth
    CHECK(imageBytes(fourccOf("INZI"), {2, 2}, 8) == in.size());
    CHECK(unpacked(fourccOf("INZI"), {2, 2}, 8, in) == std::vector<uint16_t>{1, 2, 3, 4});
    CHECK(depthLayout(fourccOf("INZI"))->rowBytes(2, 8) == 4);
    CHECK(depthLayout(fourccOf("Z16 "))->rowBytes(2, 8) == 8); // padding of a plain format counts
}

TEST_CASE("No depth is read from a colour format, and no colour from a depth format") {
    CHECK_FALSE(depthLayout(fourccOf("YUYV")));
    std::vector<uint32_t> out(2);
    CHECK(coloursFrom(fourccOf("Z16 "), {2, 1}, 4, bytesOf({0, 0, 0, 0}), out) == "not a colour format: Z16");
}

TEST_CASE("YUYV and UYVY give black, white and the primaries of BT.601, odd widths too") {
    // Pairs: black and white; then red, whose second half lies outside a frame three pixels wide.
    const auto yuyv = bytesOf({16, 128, 235, 128, 81, 90, 0, 240});
    std::vector<uint32_t> out(3);
    REQUIRE(coloursFrom(fourccOf("YUYV"), {3, 1}, 8, yuyv, out).empty());
    CHECK(out[0] == 0xff000000u);
    CHECK(out[1] == 0xffffffffu);
    CHECK((out[2] & 255) >= 253);
    CHECK((out[2] >> 8 & 0xffff) <= 0x0202);
    const auto uyvy = bytesOf({128, 16, 128, 235, 90, 81, 240, 0});
    std::vector<uint32_t> again(3);
    REQUIRE(coloursFrom(fourccOf("UYVY"), {3, 1}, 8, uyvy, again).empty());
    CHECK(again == out);
}

TEST_CASE("NV12 has chroma for two by two pixels behind its luma, at odd sizes and with gaps between rows") {
    // 3 x 3: red on the left, blue on the right; 9 is a gap.
    const auto nv12 =
        bytesOf({81, 81, 41, 9, 81, 81, 41, 9, 81, 81, 41, 9, 90, 240, 240, 110, 90, 240, 240, 110});
    std::vector<uint32_t> out;
    REQUIRE(imageBytes(fourccOf("NV12"), {3, 3}, 4) == nv12.size());
    REQUIRE(coloursFrom(fourccOf("NV12"), {3, 3}, 4, nv12, out).empty());
    for (size_t i = 0; i < out.size(); ++i) {
        const bool red = i % 3 < 2;
        CHECK((out[i] >> (red ? 0 : 16) & 255) >= 253);
        CHECK((out[i] >> (red ? 16 : 0) & 255) <= 2);
    }
    CHECK(coloursFrom(fourccOf("NV12"), {3, 3}, 4, bytesOf({81, 81, 41}), out) ==
          "a colour image of 3 bytes, 20 make one");
    CHECK(coloursFrom(fourccOf("NV12"), {3, 3}, 2, nv12, out) == "a colour image of 20 bytes, in rows of 2");
}

TEST_CASE("Colour is copied as it is sent, without the gaps between rows") {
    const auto yuyv = bytesOf({16, 128, 235, 129, 81, 90, 41, 240, 7, 7, 9, 1, 2, 3, 4, 5, 6, 7});
    constexpr VideoSize kSize{4, 2};
    std::vector<std::byte> copy(16);
    RawColour raw;
    for (const uint32_t fourcc : {fourccOf("YUYV"), fourccOf("UYVY")}) {
        REQUIRE(copyColour(fourcc, kSize, 10, yuyv, copy, raw).empty());
        CHECK(raw.format == (fourcc == fourccOf("YUYV") ? ColourFormat::Yuyv : ColourFormat::Uyvy));
        CHECK(std::ranges::equal(raw.bytes,
                                 bytesOf({16, 128, 235, 129, 81, 90, 41, 240, 9, 1, 2, 3, 4, 5, 6, 7})));
    }
    CHECK(copyColour(fourccOf("YUYV"), kSize, 10, bytesOf({16, 128, 235, 129}), copy, raw) ==
          "a colour image of 4 bytes, 18 make one");
}

TEST_CASE("RGB and BGR differ only in order, and incomplete colour is reported") {
    std::vector<uint32_t> rgb(2), bgr(2);
    REQUIRE(coloursFrom(fourccOf("RGB3"), {2, 1}, 6, bytesOf({1, 2, 3, 4, 5, 6}), rgb).empty());
    REQUIRE(coloursFrom(fourccOf("BGR3"), {2, 1}, 6, bytesOf({3, 2, 1, 6, 5, 4}), bgr).empty());
    CHECK(rgb == std::vector<uint32_t>{0xff030201u, 0xff060504u});
    CHECK(bgr == rgb);
    CHECK_FALSE(coloursFrom(fourccOf("RGB3"), {2, 1}, 6, bytesOf({1, 2, 3, 4, 5}), rgb).empty());
    CHECK_FALSE(coloursFrom(fourccOf("MJPG"), {2, 1}, 0, bytesOf({1, 2, 3, 4, 5}), rgb).empty());
    CHECK_FALSE(coloursFrom(fourccOf("MJPG"), {2, 1}, 0, {}, rgb).empty());
}
