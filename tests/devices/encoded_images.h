// SPDX-License-Identifier: Apache-2.0
// Small images in the encodings of messages, and a check that one is red.
#pragma once

#include "devices/bag/image_pixels.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/recorded_folder.h"

#include <doctest/doctest.h>
#include <string>
#include <turbojpeg.h>
#include <vector>

namespace fathom::testing {

inline constexpr uint32_t kAcross = 8, kDown = 6, kCentre = 2 * kAcross + 3;

inline ros::Image packedImage(const std::string& format, const std::string& bytes) {
    ros::Image image;
    image.compressed = true;
    image.format = format;
    image.encoding = format.substr(0, format.find(';'));
    image.data = {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
    return image;
}

// Red, by less than 6 levels of each channel.
inline bool isRed(uint32_t pixel) {
    return (pixel & 0xff) > 244 && (pixel >> 8 & 0xff) < 6 && (pixel >> 16 & 0xff) < 6 && pixel >> 24 == 255;
}

// As R8 G8 B8 A8.
inline std::string readRows(const ros::Image& image, std::vector<uint32_t>& out) {
    RawColour raw;
    std::vector<uint32_t> memory(out.size());
    const std::string fault = ros::colourRows(image, memory, raw);
    if (fault.empty()) {
        CHECK(raw.format == ros::colourFormat(image));
        raw.format == ColourFormat::Rgba ? out.swap(memory) : unpackColour(raw, out);
    }
    return fault;
}

inline void checkRed(const ros::Image& image, const std::string& name) {
    std::vector<uint32_t> out(kAcross * kDown);
    CHECK_MESSAGE(ros::content(image) == ros::Content::Colour, name);
    CHECK_MESSAGE(readRows(image, out) == "", name);
    CHECK_MESSAGE(isRed(out[0]), name);
    CHECK_MESSAGE(isRed(out[kCentre]), name);
    CHECK_MESSAGE(isRed(out.back()), name);
}

// Red cells of 2 x 2 pixels, `at` the place of red.
inline std::string mosaic(uint32_t at, uint32_t bytes) {
    std::string all;
    for (uint32_t i = 0; i < kAcross * kDown; ++i) {
        const bool red = (i / kAcross % 2) * 2 + i % 2 == at;
        all += std::string(bytes - 1, '\0') + (red ? '\xff' : '\0');
    }
    return all;
}

inline std::string encodedJpeg(const std::string& pixels, bool grey) {
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

inline std::string encodedJpeg(uint8_t r, uint8_t g, uint8_t b) {
    return encodedJpeg(filledColour(r, g, b, kAcross * kDown), false);
}

// Grey, of 8 or 16 bits.
inline std::string greyPng(const TemporaryFolder& folder, const std::string& pixels, int bits) {
    writePng(folder.path() / "grey.png", kAcross, kDown, bits, 0, {pixels.begin(), pixels.end()});
    return folder.read("grey.png");
}

} // namespace fathom::testing
