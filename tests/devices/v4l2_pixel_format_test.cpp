// SPDX-License-Identifier: Apache-2.0
// V4L2 pixel layouts, without a camera.
#include "devices/v4l2/pixel_format.h"

#include "engine/types/yuyv.h"

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
    CHECK_FALSE(unpackColour(fourccOf("Z16 "), {2, 1}, 4, bytesOf({0, 0, 0, 0}), out).empty());
}

TEST_CASE("YUYV and UYVY give black, white and the primaries of BT.601, odd widths too") {
    // Pairs: black and white; then red, whose second half lies outside a frame three pixels wide.
    const auto yuyv = bytesOf({16, 128, 235, 128, 81, 90, 0, 240});
    std::vector<uint32_t> out(3);
    REQUIRE(unpackColour(fourccOf("YUYV"), {3, 1}, 8, yuyv, out).empty());
    CHECK(out[0] == 0xff000000u);
    CHECK(out[1] == 0xffffffffu);
    CHECK((out[2] & 255) >= 253);
    CHECK((out[2] >> 8 & 0xffff) <= 0x0202);
    const auto uyvy = bytesOf({128, 16, 128, 235, 90, 81, 240, 0});
    std::vector<uint32_t> again(3);
    REQUIRE(unpackColour(fourccOf("UYVY"), {3, 1}, 8, uyvy, again).empty());
    CHECK(again == out);
}

TEST_CASE("YUYV and UYVY are copied as words without the gaps between rows, and unpack to what they are") {
    const auto yuyv = bytesOf({16, 128, 235, 129, 81, 90, 41, 240, 7, 7, 9, 1, 2, 3, 4, 5, 6, 7});
    const auto uyvy = bytesOf({128, 16, 129, 235, 90, 81, 240, 41, 7, 7, 1, 9, 3, 2, 5, 4, 7, 6});
    constexpr VideoSize kSize{4, 2};
    std::vector<uint32_t> words(4), again(4), rgba(8), unpacked(8);
    REQUIRE(copyYuyv(fourccOf("YUYV"), kSize, 10, yuyv, words).empty());
    REQUIRE(copyYuyv(fourccOf("UYVY"), kSize, 10, uyvy, again).empty());
    CHECK(words == std::vector<uint32_t>{0x81eb8010u, 0xf0295a51u, 0x03020109u, 0x07060504u});
    CHECK(again == words);
    REQUIRE(unpackColour(fourccOf("YUYV"), kSize, 10, yuyv, rgba).empty());
    unpackYuyv(words, unpacked);
    CHECK(unpacked == rgba);
    CHECK(isYuyv(fourccOf("UYVY")));
    CHECK_FALSE(isYuyv(fourccOf("RGB3")));
    CHECK(copyYuyv(fourccOf("YUYV"), kSize, 10, bytesOf({16, 128, 235, 129}), words) ==
          "a colour image of 4 bytes, 18 make one");
}

TEST_CASE("RGB and BGR differ only in order, and incomplete colour is reported") {
    std::vector<uint32_t> rgb(2), bgr(2);
    REQUIRE(unpackColour(fourccOf("RGB3"), {2, 1}, 6, bytesOf({1, 2, 3, 4, 5, 6}), rgb).empty());
    REQUIRE(unpackColour(fourccOf("BGR3"), {2, 1}, 6, bytesOf({3, 2, 1, 6, 5, 4}), bgr).empty());
    CHECK(rgb == std::vector<uint32_t>{0xff030201u, 0xff060504u});
    CHECK(bgr == rgb);
    CHECK_FALSE(unpackColour(fourccOf("RGB3"), {2, 1}, 6, bytesOf({1, 2, 3, 4, 5}), rgb).empty());
    CHECK_FALSE(unpackColour(fourccOf("MJPG"), {2, 1}, 0, bytesOf({1, 2, 3, 4, 5}), rgb).empty());
    CHECK_FALSE(unpackColour(fourccOf("MJPG"), {2, 1}, 0, {}, rgb).empty());
}
