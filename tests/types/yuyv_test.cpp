// SPDX-License-Identifier: Apache-2.0
// Compares YUYV with the formulas of BT.601, and tests readers of YUYV frames.
#include "engine/types/colour_copy.h"
#include "engine/types/yuyv.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

int channel(uint32_t rgba, int i) {
    return static_cast<int>(rgba >> (8 * i) & 255);
}

// ITU-R BT.601: Kr = 0.299, Kb = 0.114; luma 16..235, chroma 16..240 about 128.
std::array<double, 3> exactRgb(int luma, int u, int v) {
    const double y = 255.0 / 219.0 * (luma - 16), b = 255.0 / 224.0 * (u - 128),
                 r = 255.0 / 224.0 * (v - 128);
    const double red = y + 1.402 * r, blue = y + 1.772 * b;
    const double green = (y - 0.299 * red - 0.114 * blue) / 0.587;
    return {std::clamp(red, 0.0, 255.0), std::clamp(green, 0.0, 255.0), std::clamp(blue, 0.0, 255.0)};
}

// Largest error of any channel, over all chroma at one luma.
double largestError(uint32_t luma) {
    double worst = 0.0;
    for (uint32_t uv = 0; uv < 65536; ++uv) {
        const uint32_t u = uv & 255, v = uv >> 8;
        const uint32_t rgba = rgbaOfYuyv(luma | u << 8 | v << 24)[0];
        const auto exact = exactRgb(static_cast<int>(luma), static_cast<int>(u), static_cast<int>(v));
        for (int i = 0; i < 3; ++i) {
            worst = std::max(worst, std::abs(channel(rgba, i) - exact[static_cast<size_t>(i)]));
        }
    }
    return worst;
}

std::vector<uint32_t> fewColours() {
    return {0xff000000u, 0xffffffffu, 0xff2020c0u, 0xff2020c0u, 0xff808080u, 0xff20b0c0u};
}

} // namespace

TEST_CASE("YUYV unpacks to BT.601 red, green and blue within one step, for every luma and chroma") {
    double worst = 0.0;
    for (uint32_t luma = 0; luma < 256; ++luma) {
        worst = std::max(worst, largestError(luma));
    }
    CHECK(worst < 1.0);
    MESSAGE("largest distance from the formula: ", worst, " of 255");
}

TEST_CASE("Both pixels of a word have their own luma and share one chroma") {
    const auto pair = rgbaOfYuyv(16u | 128u << 8 | 235u << 16 | 128u << 24);
    CHECK(pair[0] == 0xff000000u);
    CHECK(pair[1] == 0xffffffffu);
    CHECK(rgbaOfYuyv(0u)[0] == rgbaOfYuyv(0u)[1]);
}

TEST_CASE("Colours in equal pairs return within two steps, greys within one and without chroma") {
    double worst = 0.0;
    for (uint32_t k = 0; k < 32 * 32 * 32; ++k) {
        const uint32_t c = 0xff000000u | (k & 31) * 8 | (k >> 5 & 31) * 8 << 8 | (k >> 10) * 8 << 16;
        const std::array<uint32_t, 2> in{c, c};
        std::array<uint32_t, 1> word{};
        packYuyv(in, word);
        const auto out = rgbaOfYuyv(word[0]);
        CHECK(out[0] == out[1]);
        for (int i = 0; i < 3; ++i) {
            worst = std::max(worst, static_cast<double>(std::abs(channel(c, i) - channel(out[0], i))));
        }
    }
    CHECK(worst <= 2.0);
    for (uint32_t grey = 0; grey < 256; ++grey) {
        const std::array<uint32_t, 2> in{0xff000000u | grey * 0x010101u, 0xff000000u | grey * 0x010101u};
        std::array<uint32_t, 1> word{};
        packYuyv(in, word);
        CHECK((word[0] >> 8 & 255) == 128);
        CHECK((word[0] >> 24) == 128);
        CHECK(std::abs(channel(rgbaOfYuyv(word[0])[0], 1) - static_cast<int>(grey)) <= 1);
    }
}

TEST_CASE("Two unlike pixels keep their own luma and share the mean of their chroma") {
    const auto wordOf = [](uint32_t a, uint32_t b) {
        const std::array<uint32_t, 2> in{a, b};
        std::array<uint32_t, 1> word{};
        packYuyv(in, word);
        return word[0];
    };
    constexpr uint32_t kRed = 0xff2020c0u, kBlue = 0xffc02020u;
    const uint32_t red = wordOf(kRed, kRed), blue = wordOf(kBlue, kBlue), mixed = wordOf(kRed, kBlue);
    CHECK((mixed & 255) == (red & 255));
    CHECK((mixed >> 16 & 255) == (blue & 255));
    for (const int shift : {8, 24}) {
        const int mean = static_cast<int>((red >> shift & 255) + (blue >> shift & 255)) / 2;
        CHECK(std::abs(static_cast<int>(mixed >> shift & 255) - mean) <= 1);
    }
    CHECK((red & 255) != (blue & 255));
}

TEST_CASE(
    "Readers of a frame's colours get the same from YUYV and its unpacked form, directly or from a copy") {
    const std::vector<uint32_t> rgba = fewColours();
    std::vector<uint32_t> words(rgba.size() / 2), unpacked(rgba.size());
    packYuyv(rgba, words);
    unpackYuyv(words, unpacked);
    Frame::Content sent, plain, none;
    sent.yuyv = words, plain.colour = unpacked;
    std::vector<uint32_t> out{1, 2, 3};
    ColourCopy copy;
    for (const Frame::Content* content : {&sent, &plain, &sent}) {
        readColours(*content, out);
        CHECK(out == unpacked);
        copy.take(*content);
        out = {7};
        copy.giveTo(out);
        CHECK(out == unpacked);
    }
    readColours(none, out);
    CHECK(out.empty());
    copy.take(none);
    copy.giveTo(out);
    CHECK(out.empty());
}
