// SPDX-License-Identifier: Apache-2.0
#include "apps/verify/pack_colour.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fathom::verify {

namespace {

struct YuvBytes {
    std::byte y, u, v;
};

std::byte roundedByte(double value) {
    return static_cast<std::byte>(std::clamp(std::lround(value), 0l, 255l));
}

// BT.601 of red, green, blue 0..255; full range by ITU-T T.871, else limited.
YuvBytes yuvOf(const std::array<double, 3>& rgb, bool full) {
    const auto& [r, g, b] = rgb;
    const double y = 0.299 * r + 0.587 * g + 0.114 * b, u = (b - y) / 1.772, v = (r - y) / 1.402;
    return full ? YuvBytes{roundedByte(y), roundedByte(128.0 + u), roundedByte(128.0 + v)}
                : YuvBytes{roundedByte(16.0 + 219.0 / 255.0 * y), roundedByte(128.0 + 224.0 / 255.0 * u),
                           roundedByte(128.0 + 224.0 / 255.0 * v)};
}

// Writes the bytes of an image, pixel by pixel.
class ColourPacker {
public:
    ColourPacker(PackedColour& out, std::span<const uint32_t> rgba)
        : out_(out)
        , rgba_(rgba) {}

    void bytes(bool redFirst) {
        for (size_t i = 0; i < rgba_.size(); ++i) {
            for (size_t c = 0; c < 3; ++c) {
                out_.bytes[3 * i + (redFirst ? c : 2 - c)] =
                    static_cast<std::byte>(rgba_[i] >> (8 * c) & 255);
            }
        }
    }
    void pairs(bool lumaFirst) {
        std::byte* to = out_.bytes.data();
        for (uint32_t y = 0; y < out_.layout.height; ++y) {
            const uint32_t* row = rgba_.data() + size_t{y} * out_.layout.width;
            for (uint32_t x = 0; x < out_.layout.width; x += 2, to += 4) {
                const std::array<uint32_t, 2> pair{row[x], row[std::min(x + 1, out_.layout.width - 1)]};
                std::array<uint32_t, 1> word{};
                packYuyv(pair, word);
                const uint32_t uyvy = (word[0] >> 8 & 0x00ff00ffu) | (word[0] & 0x00ff00ffu) << 8;
                std::memcpy(to, lumaFirst ? &word[0] : &uyvy, sizeof uyvy);
            }
        }
    }
    void planes(bool full) {
        const ColourPlanes& p = out_.layout.planes;
        const uint32_t across = 1u << p.across, down = 1u << p.down;
        for (uint32_t y = 0; y < out_.layout.height; ++y) {
            for (uint32_t x = 0; x < out_.layout.width; ++x) {
                out_.bytes[size_t{y} * p.lumaStep + x] = yuvOf(meanOf(x, y, 1, 1), full).y;
                if (x % across == 0 && y % down == 0) {
                    const YuvBytes block = yuvOf(meanOf(x, y, across, down), full);
                    const size_t at = size_t{y >> p.down} * p.chromaStep + (size_t{x >> p.across} << p.apart);
                    out_.bytes[p.blue + at] = block.u, out_.bytes[p.red + at] = block.v;
                }
            }
        }
    }

private:
    // Of the pixels from (x, y) on that are inside.
    std::array<double, 3> meanOf(uint32_t x, uint32_t y, uint32_t across, uint32_t down) const {
        std::array<double, 3> sum{};
        const uint32_t right = std::min(x + across, out_.layout.width),
                       below = std::min(y + down, out_.layout.height);
        for (uint32_t v = y; v < below; ++v) {
            for (uint32_t u = x; u < right; ++u) {
                for (size_t c = 0; c < 3; ++c) {
                    sum[c] += rgba_[size_t{v} * out_.layout.width + u] >> (8 * c) & 255;
                }
            }
        }
        std::ranges::for_each(sum, [&](double& c) { c /= (right - x) * (below - y); });
        return sum;
    }

    PackedColour& out_;
    std::span<const uint32_t> rgba_;
};

ColourPlanes placesOf(ColourFormat format, uint32_t width, uint32_t height) {
    const uint32_t pairs = (width + 1) / 2;
    if (format == ColourFormat::Planes) {
        return {width, width * height, width * height + 1, 2 * pairs, 1, 1, 1};
    }
    const uint32_t luma = (width + 3) / 4 * 4, chroma = (pairs + 3) / 4 * 4;
    return {luma, luma * height, (luma + chroma) * height, chroma, 1, 0, 0};
}

} // namespace

PackedColour packColour(ColourFormat format, uint32_t width, uint32_t height,
                        std::span<const uint32_t> rgba) {
    PackedColour out{{}, {format, width, height, {}}};
    out.layout.planes = placesOf(format, width, height);
    out.bytes.resize(mostColourBytes(format, width, height));
    ColourPacker pack(out, rgba);
    switch (format) {
    case ColourFormat::Rgba:
        std::ranges::copy(std::as_bytes(rgba), out.bytes.begin());
        break;
    case ColourFormat::Rgb:
    case ColourFormat::Bgr:
        pack.bytes(format == ColourFormat::Rgb);
        break;
    case ColourFormat::Yuyv:
    case ColourFormat::Uyvy:
        pack.pairs(format == ColourFormat::Yuyv);
        break;
    default:
        pack.planes(format == ColourFormat::JpegPlanes);
    }
    out.bytes.resize(out.layout.needed());
    return out;
}

} // namespace fathom::verify
