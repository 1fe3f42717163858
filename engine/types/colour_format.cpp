// SPDX-License-Identifier: Apache-2.0
#include "engine/types/colour_format.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace fathom {

namespace {

uint32_t byteOf(int value) {
    return static_cast<uint32_t>(std::clamp(value, 0, 255));
}

uint32_t rgbaOf(uint32_t r, uint32_t g, uint32_t b) {
    return r | g << 8 | b << 16 | 0xff000000u;
}

// BT.601: luma 16..235, chroma 16..240 about 128, of red, green, blue 0..255; in 1/65536.
uint32_t lumaOf(uint32_t rgba) {
    const int r = rgba & 255, g = rgba >> 8 & 255, b = rgba >> 16 & 255;
    return byteOf((16829 * r + 33039 * g + 6416 * b + (16 << 16) + 32768) >> 16);
}

// red, green, blue: sums of two pixels.
uint32_t chromaOf(int red, int green, int blue, int ofRed, int ofGreen, int ofBlue) {
    return byteOf((ofRed * red + ofGreen * green + ofBlue * blue + (128 << 17) + 65536) >> 17);
}

bool planar(ColourFormat format) {
    return format == ColourFormat::Planes || format == ColourFormat::JpegPlanes;
}

uint64_t upTo(uint64_t multiple, uint64_t value) {
    return (value + multiple - 1) / multiple * multiple;
}

void pairsRow(const uint8_t* in, bool lumaFirst, uint32_t width, uint32_t* out) {
    const uint32_t luma = lumaFirst ? 0 : 1, chroma = 1 - luma;
    for (uint32_t x = 0; x < width; ++x) {
        const uint8_t* pair = in + size_t{4} * (x / 2);
        out[x] = rgbaOfYuv(pair[luma + 2 * (x & 1)], pair[chroma], pair[chroma + 2]);
    }
}

void bytesRow(const uint8_t* in, bool redFirst, uint32_t width, uint32_t* out) {
    const uint32_t red = redFirst ? 0 : 2;
    for (uint32_t x = 0; x < width; ++x, in += 3) {
        out[x] = rgbaOf(in[red], in[1], in[2 - red]);
    }
}

template <class Rgba>
void planesRow(const uint8_t* bytes, const RawColour& image, uint32_t y, uint32_t* out, Rgba&& rgba) {
    const ColourPlanes& p = image.planes;
    const uint8_t *luma = bytes + size_t{y} * p.lumaStep,
                  *chroma = bytes + size_t{y >> p.down} * p.chromaStep;
    for (uint32_t x = 0; x < image.width; ++x) {
        const size_t at = size_t{x >> p.across} << p.apart;
        out[x] = rgba(luma[x], chroma[p.blue + at], chroma[p.red + at]);
    }
}

} // namespace

const char* nameOf(ColourFormat format) noexcept {
    constexpr std::array kNames{"RGBA", "YUYV", "UYVY", "RGB", "BGR", "planes of YUV", "planes of JPEG"};
    return kNames[static_cast<size_t>(format)];
}

uint64_t mostColourBytes(ColourFormat format, uint32_t width, uint32_t height) noexcept {
    const uint64_t w = width, h = height;
    switch (format) {
    case ColourFormat::Rgba:
        return 4 * w * h;
    case ColourFormat::Yuyv:
    case ColourFormat::Uyvy:
        return 2 * upTo(2, w) * h;
    case ColourFormat::Rgb:
    case ColourFormat::Bgr:
        return 3 * w * h;
    case ColourFormat::Planes:
        return w * h + upTo(2, w) * upTo(2, h) / 2;
    case ColourFormat::JpegPlanes:
        break;
    }
    return 3 * upTo(4, w) * upTo(2, h);
}

uint64_t RawColour::needed() const noexcept {
    if (!planar(format) || width == 0 || height == 0) {
        return mostColourBytes(format, width, height);
    }
    const uint64_t luma = uint64_t{height - 1} * planes.lumaStep + width;
    const uint64_t chroma = uint64_t{(height - 1) >> planes.down} * planes.chromaStep +
                            (uint64_t{(width - 1) >> planes.across} << planes.apart) + 1;
    return std::max(luma, std::max(planes.blue, planes.red) + chroma);
}

uint32_t rgbaOfYuv(uint32_t y, uint32_t u, uint32_t v) noexcept {
    const int c = 298 * (static_cast<int>(y) - 16) + 128, d = static_cast<int>(u) - 128,
              e = static_cast<int>(v) - 128;
    return rgbaOf(byteOf((c + 409 * e) >> 8), byteOf((c - 100 * d - 208 * e) >> 8),
                  byteOf((c + 516 * d) >> 8));
}

uint32_t rgbaOfJpeg(uint32_t y, uint32_t u, uint32_t v) noexcept {
    const int c = static_cast<int>(y), d = static_cast<int>(u) - 128, e = static_cast<int>(v) - 128;
    return rgbaOf(byteOf(c + ((91881 * e + 32768) >> 16)),
                  byteOf(c + ((-22554 * d - 46802 * e + 32768) >> 16)),
                  byteOf(c + ((116130 * d + 32768) >> 16)));
}

void unpackRow(const RawColour& image, uint32_t y, std::span<uint32_t> rgba) noexcept {
    const auto* bytes = reinterpret_cast<const uint8_t*>(image.bytes.data());
    const size_t row = mostColourBytes(image.format, image.width, 1);
    switch (image.format) {
    case ColourFormat::Rgba:
        std::memcpy(rgba.data(), bytes + y * row, row);
        break;
    case ColourFormat::Yuyv:
    case ColourFormat::Uyvy:
        pairsRow(bytes + y * row, image.format == ColourFormat::Yuyv, image.width, rgba.data());
        break;
    case ColourFormat::Rgb:
    case ColourFormat::Bgr:
        bytesRow(bytes + y * row, image.format == ColourFormat::Rgb, image.width, rgba.data());
        break;
    case ColourFormat::Planes:
        planesRow(bytes, image, y, rgba.data(), rgbaOfYuv);
        break;
    case ColourFormat::JpegPlanes:
        planesRow(bytes, image, y, rgba.data(), rgbaOfJpeg);
        break;
    }
}

void unpackColour(const RawColour& image, std::span<uint32_t> rgba) noexcept {
    for (uint32_t y = 0; y < image.height; ++y) {
        unpackRow(image, y, rgba.subspan(size_t{y} * image.width, image.width));
    }
}

bool isDark(const RawColour& image) {
    constexpr uint32_t kRows = 16, kBright = 16;
    std::vector<uint32_t> row(image.width);
    size_t bright = 0;
    for (uint32_t i = 0; i < kRows && bright * 100 <= size_t{kRows} * image.width; ++i) {
        if (image.bytes.empty() || image.height == 0) {
            return false;
        }
        unpackRow(image, (2 * i + 1) * image.height / (2 * kRows), row);
        bright += static_cast<size_t>(std::count_if(row.begin(), row.end(), [](uint32_t c) {
            return std::max({c & 255, c >> 8 & 255, c >> 16 & 255}) > kBright;
        }));
    }
    return bright * 100 <= size_t{kRows} * image.width;
}

void packYuyv(std::span<const uint32_t> rgba, std::span<uint32_t> words) noexcept {
    for (size_t i = 0; i < words.size(); ++i) {
        const uint32_t a = rgba[2 * i], b = rgba[2 * i + 1];
        const auto sum = [&](int shift) { return static_cast<int>((a >> shift & 255) + (b >> shift & 255)); };
        const int red = sum(0), green = sum(8), blue = sum(16);
        words[i] = lumaOf(a) | chromaOf(red, green, blue, -9714, -19070, 28784) << 8 | lumaOf(b) << 16 |
                   chromaOf(red, green, blue, 28784, -24103, -4681) << 24;
    }
}

} // namespace fathom
