// SPDX-License-Identifier: Apache-2.0
// Compares the unpacked colours of every camera format with the formulas of BT.601 and the places of its
// bytes, and tests readers of frames that have them.
#include "engine/types/colour_copy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;

namespace {

using Rgb = std::array<double, 3>;

int channel(uint32_t rgba, size_t i) {
    return static_cast<int>(rgba >> (8 * i) & 255);
}

// ITU-R BT.601: Kr = 0.299, Kb = 0.114. Limited: luma 16..235, chroma 16..240 about 128. Full: ITU-T T.871.
Rgb exactRgb(int luma, int u, int v, bool full) {
    const double y = full ? luma : 255.0 / 219.0 * (luma - 16), scale = full ? 1.0 : 255.0 / 224.0;
    const double b = scale * (u - 128), r = scale * (v - 128);
    const double red = y + 1.402 * r, blue = y + 1.772 * b;
    const double green = (y - 0.299 * red - 0.114 * blue) / 0.587;
    return {std::clamp(red, 0.0, 255.0), std::clamp(green, 0.0, 255.0), std::clamp(blue, 0.0, 255.0)};
}

double errorOf(uint32_t rgba, const Rgb& exact) {
    double worst = 0.0;
    for (size_t i = 0; i < 3; ++i) {
        worst = std::max(worst, std::abs(channel(rgba, i) - exact[i]));
    }
    return worst;
}

// Largest error of any channel, over all luma and chroma.
double largestError(bool full) {
    double worst = 0.0;
    for (int yuv = 0; yuv < 1 << 24; ++yuv) {
        const int y = yuv >> 16, u = yuv & 255, v = yuv >> 8 & 255;
        const auto rgba = full ? rgbaOfJpeg : rgbaOfYuv;
        worst = std::max(
            worst, errorOf(rgba(static_cast<uint32_t>(y), static_cast<uint32_t>(u), static_cast<uint32_t>(v)),
                           exactRgb(y, u, v, full)));
    }
    return worst;
}

// The colour of pixel (x, y), from the definition of its format.
Rgb exactPixel(const RawColour& image, size_t x, size_t y) {
    const auto at = [&](size_t place) { return static_cast<int>(image.bytes[place]); };
    const size_t pixel = y * image.width + x, pair = 4 * (y * ((size_t{image.width} + 1) / 2) + x / 2),
                 second = 2 * (x % 2);
    const ColourPlanes& p = image.planes;
    const size_t columns = size_t{1} << p.across, rows = size_t{1} << p.down, apart = size_t{1} << p.apart;
    const size_t chroma = y / rows * p.chromaStep + x / columns * apart;
    switch (image.format) {
    case ColourFormat::Yuyv:
        return exactRgb(at(pair + second), at(pair + 1), at(pair + 3), false);
    case ColourFormat::Uyvy:
        return exactRgb(at(pair + second + 1), at(pair), at(pair + 2), false);
    case ColourFormat::Bgr:
        return {at(3 * pixel + 2) * 1.0, at(3 * pixel + 1) * 1.0, at(3 * pixel) * 1.0};
    case ColourFormat::Planes:
    case ColourFormat::JpegPlanes:
        return exactRgb(at(y * p.lumaStep + x), at(p.blue + chroma), at(p.red + chroma),
                        image.format == ColourFormat::JpegPlanes);
    default:
        return {at(3 * pixel) * 1.0, at(3 * pixel + 1) * 1.0, at(3 * pixel + 2) * 1.0};
    }
}

// Unpacks random bytes and returns the largest error.
double errorOfRandom(RawColour image) {
    std::mt19937 random(7);
    std::vector<std::byte> bytes(image.needed());
    std::ranges::generate(bytes, [&] { return static_cast<std::byte>(random() & 255); });
    image.bytes = bytes;
    std::vector<uint32_t> rgba(size_t{image.width} * image.height);
    unpackColour(image, rgba);
    double worst = 0.0;
    for (size_t i = 0; i < rgba.size(); ++i) {
        worst = std::max(worst, errorOf(rgba[i], exactPixel(image, i % image.width, i / image.width)));
    }
    return worst;
}

uint32_t packedWord(uint32_t a, uint32_t b) {
    const std::array<uint32_t, 2> in{a, b};
    std::array<uint32_t, 1> word{};
    packYuyv(in, word);
    return word[0];
}

// Both pixels of a word of YUYV.
std::array<uint32_t, 2> unpackedWord(uint32_t word) {
    std::array<uint32_t, 2> out{};
    unpackColour({ColourFormat::Yuyv, 2, 1, std::as_bytes(std::span(&word, 1))}, out);
    return out;
}

std::vector<uint32_t> fewColours() {
    return {0xff000000u, 0xffffffffu, 0xff2020c0u, 0xff2020c0u, 0xff808080u, 0xff20b0c0u};
}

} // namespace

TEST_CASE("Y U V unpack to BT.601 red, green and blue within one step, for every luma and chroma") {
    CHECK(largestError(false) < 1.0);
    CHECK(largestError(true) < 0.6);
}

TEST_CASE("Every format unpacks each pixel from its own bytes, at odd sizes too") {
    for (const auto& [w, h] :
         {std::pair(1u, 1u), std::pair(5u, 3u), std::pair(8u, 6u), std::pair(63u, 41u)}) {
        const uint32_t width = w; // a lambda captures no structured binding
        CAPTURE(width);
        for (const ColourFormat format :
             {ColourFormat::Yuyv, ColourFormat::Uyvy, ColourFormat::Rgb, ColourFormat::Bgr}) {
            CAPTURE(nameOf(format));
            CHECK(errorOfRandom({format, w, h, {}}) < 1.0);
        }
        const uint32_t pairs = (w + 1) / 2, luma = w * h, plane = pairs * ((h + 1) / 2);
        const ColourPlanes nv12{w, luma, luma + 1, 2 * pairs, 1, 1, 1},
            yv12{w, luma + plane, luma, pairs, 1, 1, 0},
            wide{w + 3, (w + 3) * h, (w + 3) * h + pairs * h, pairs, 1, 0, 0},
            grey{w, luma, luma, 0, 31, 31, 0};
        for (const ColourPlanes& planes : {nv12, yv12, wide, grey}) {
            CAPTURE(planes.across);
            CHECK(errorOfRandom({ColourFormat::Planes, w, h, {}, planes}) < 1.0);
            CHECK(errorOfRandom({ColourFormat::JpegPlanes, w, h, {}, planes}) < 1.0);
        }
    }
}

TEST_CASE("Both pixels of a word have their own luma and share one chroma") {
    const auto pair = unpackedWord(16u | 128u << 8 | 235u << 16 | 128u << 24);
    CHECK(pair[0] == 0xff000000u);
    CHECK(pair[1] == 0xffffffffu);
    CHECK(unpackedWord(0u)[0] == unpackedWord(0u)[1]);
}

TEST_CASE("Colours in equal pairs return within two steps, greys within one and without chroma") {
    double worst = 0.0;
    for (uint32_t k = 0; k < 32 * 32 * 32; ++k) {
        const uint32_t c = 0xff000000u | (k & 31) * 8 | (k >> 5 & 31) * 8 << 8 | (k >> 10) * 8 << 16;
        const auto out = unpackedWord(packedWord(c, c));
        CHECK(out[0] == out[1]);
        for (size_t i = 0; i < 3; ++i) {
            worst = std::max(worst, static_cast<double>(std::abs(channel(c, i) - channel(out[0], i))));
        }
    }
    CHECK(worst <= 2.0);
    for (uint32_t grey = 0; grey < 256; ++grey) {
        const uint32_t rgba = 0xff000000u | grey * 0x010101u, word = packedWord(rgba, rgba);
        CHECK((word >> 8 & 255) == 128);
        CHECK((word >> 24) == 128);
        CHECK(std::abs(channel(unpackedWord(word)[0], 1) - static_cast<int>(grey)) <= 1);
    }
}

TEST_CASE("Two unlike pixels keep their own luma and share the mean of their chroma") {
    constexpr uint32_t kRed = 0xff2020c0u, kBlue = 0xffc02020u;
    const uint32_t red = packedWord(kRed, kRed), blue = packedWord(kBlue, kBlue),
                   mixed = packedWord(kRed, kBlue);
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
    Frame::Content sent, plain, none;
    sent.raw = {ColourFormat::Yuyv, 6, 1, std::as_bytes(std::span(words))};
    unpackColour(sent.raw, unpacked);
    plain.colour = unpacked;
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

TEST_CASE("An image is dark if 99 % of its pixels are, in every format; an empty image is not") {
    constexpr uint32_t kWidth = 64, kHeight = 48;
    const auto dark = [](ColourFormat format, uint32_t black, uint32_t bright, size_t spots) {
        std::vector<uint32_t> rgba(kWidth * kHeight, black);
        for (size_t i = 0; i < spots; ++i) {
            rgba[kWidth * (kHeight / 32) + i] = bright; // a row that is looked at
        }
        std::vector<std::byte> bytes(rgba.size() * 4);
        if (format == ColourFormat::Rgba) {
            std::memcpy(bytes.data(), rgba.data(), bytes.size());
        } else if (format == ColourFormat::Yuyv) {
            std::vector<uint32_t> words(rgba.size() / 2);
            packYuyv(rgba, words);
            std::memcpy(bytes.data(), words.data(), words.size() * 4);
        } else {
            for (size_t i = 0; i < rgba.size(); ++i) {
                std::memcpy(bytes.data() + 3 * i, &rgba[i], 3);
            }
        }
        return isDark({format, kWidth, kHeight, bytes});
    };
    for (const ColourFormat format :
         {ColourFormat::Rgba, ColourFormat::Yuyv, ColourFormat::Rgb, ColourFormat::Bgr}) {
        CHECK(dark(format, 0xff000000, 0, 0));
        CHECK(dark(format, 0xff0a0a0a, 0xffffffff, 8)); // of 1024
        CHECK_FALSE(dark(format, 0xff0a0a0a, 0xffffffff, 16));
        CHECK_FALSE(dark(format, 0xff202020, 0, 0));
        CHECK_FALSE(dark(format, 0xff00ff00, 0, 0));
    }
    CHECK_FALSE(isDark({}));
    CHECK_FALSE(isDark({ColourFormat::Rgba, kWidth, kHeight, {}}));
}
