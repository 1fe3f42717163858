// SPDX-License-Identifier: Apache-2.0
// Planes of a JPEG, compared with the colours that libjpeg-turbo makes of it.
#include "devices/v4l2/jpeg_image.h"

#include <cstring>
#include <doctest/doctest.h>
#include <turbojpeg.h>
#include <vector>

using namespace fathom;

namespace {

// Waves of colour, so that neighbours differ in luma and chroma.
std::vector<std::byte> jpegOf(VideoSize size, int sampling, int flags = 0) {
    std::vector<unsigned char> rgb;
    for (uint32_t i = 0; i < size.width * size.height; ++i) {
        const uint32_t x = i % size.width, y = i / size.width;
        rgb.insert(rgb.end(),
                   {static_cast<unsigned char>(37 * x), static_cast<unsigned char>(53 * y + 11 * x),
                    static_cast<unsigned char>(91 * (x + y))});
    }
    const tjhandle encoder = tjInitCompress();
    unsigned char* made = nullptr;
    unsigned long bytes = 0;
    tjCompress2(encoder, rgb.data(), static_cast<int>(size.width), 0, static_cast<int>(size.height), TJPF_RGB,
                &made, &bytes, sampling, 95, flags);
    std::vector<std::byte> out(bytes);
    std::memcpy(out.data(), made, bytes);
    tjFree(made);
    tjDestroy(encoder);
    return out;
}

// With each sample of chroma for all pixels that share it, as the planes are unpacked.
std::vector<uint32_t> decodedWhole(const std::vector<std::byte>& jpeg, VideoSize size) {
    std::vector<uint32_t> rgba(size_t{size.width} * size.height);
    const tjhandle decoder = tjInitDecompress();
    tjDecompress2(decoder, reinterpret_cast<const unsigned char*>(jpeg.data()), jpeg.size(),
                  reinterpret_cast<unsigned char*>(rgba.data()), static_cast<int>(size.width), 0,
                  static_cast<int>(size.height), TJPF_RGBA, TJFLAG_FASTUPSAMPLE);
    tjDestroy(decoder);
    return rgba;
}

std::string planesOf(const std::vector<std::byte>& jpeg, VideoSize size, std::vector<std::byte>& memory,
                     RawColour& raw) {
    memory.resize(mostColourBytes(ColourFormat::JpegPlanes, size.width, size.height));
    return readJpeg(jpeg, size, memory, raw);
}

} // namespace

TEST_CASE("The planes of a JPEG of any sampling and size unpack to the bytes of libjpeg-turbo") {
    for (const int sampling : {TJSAMP_444, TJSAMP_422, TJSAMP_420, TJSAMP_440, TJSAMP_411, TJSAMP_GRAY}) {
        CAPTURE(sampling);
        for (const VideoSize size :
             {VideoSize{1, 1}, VideoSize{17, 9}, VideoSize{63, 41}, VideoSize{64, 48}}) {
            CAPTURE(size.width);
            const auto jpeg = jpegOf(size, sampling);
            std::vector<std::byte> memory;
            RawColour raw;
            REQUIRE(planesOf(jpeg, size, memory, raw) == "");
            REQUIRE(raw.needed() <= raw.bytes.size());
            std::vector<uint32_t> rgba(size_t{size.width} * size.height);
            unpackColour(raw, rgba);
            CHECK(rgba == decodedWhole(jpeg, size));
        }
    }
}

TEST_CASE("A few bytes in front of the end marker, as webcams send them, change no pixel; many are a fault") {
    const VideoSize size{64, 48};
    for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
        const auto jpeg = jpegOf(size, TJSAMP_420, flags);
        std::vector<std::byte> memory;
        RawColour raw;
        REQUIRE(planesOf(jpeg, size, memory, raw) == "");
        for (const size_t padding : {1u, 2u, 8u, 16u}) {
            auto padded = jpeg;
            padded.insert(padded.end() - 2, padding, std::byte{0});
            std::vector<std::byte> other;
            CHECK(planesOf(padded, size, other, raw) == "");
            CHECK(other == memory);
            padded.insert(padded.end() - 2, 100, std::byte{0});
            const std::string fault = planesOf(padded, size, other, raw);
            CHECK_MESSAGE(fault.find("extraneous bytes before marker 0xd9") != std::string::npos, fault);
        }
    }
}

TEST_CASE("A JPEG of another size, cut short, or without Y Cb Cr is a fault") {
    auto jpeg = jpegOf({64, 48}, TJSAMP_420);
    std::vector<std::byte> memory;
    RawColour raw;
    CHECK(planesOf(jpeg, {64, 47}, memory, raw) == "JPEG of 64x48, 64x47 was agreed");
    auto cut = jpeg;
    cut.resize(jpeg.size() / 2);
    CHECK(planesOf(cut, {64, 48}, memory, raw).starts_with("JPEG: "));
    // Component numbers R, G, B and no JFIF header: red, green, blue.
    jpeg = jpegOf({16, 16}, TJSAMP_444);
    jpeg.erase(jpeg.begin() + 2, jpeg.begin() + 20);
    const auto number = [&](std::byte marker, size_t from, size_t step) {
        for (size_t i = 0; i + from + 2 * step < jpeg.size(); ++i) {
            if (jpeg[i] == std::byte{0xff} && jpeg[i + 1] == marker) {
                for (size_t c = 0; c < 3; ++c) {
                    jpeg[i + from + c * step] = static_cast<std::byte>("RGB"[c]);
                }
                return;
            }
        }
    };
    number(std::byte{0xc0}, 10, 3), number(std::byte{0xda}, 5, 2);
    CHECK(planesOf(jpeg, {16, 16}, memory, raw) == "JPEG: colour space 0 (allowed: Y Cb Cr, grey)");
    CHECK(raw.format == ColourFormat::Rgba); // untouched
}
