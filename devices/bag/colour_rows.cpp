// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/colour_rows.h"

#include "engine/types/yuyv.h"

#include <algorithm>
#include <array>

namespace fathom::ros {

namespace {

constexpr std::array kLayouts{
    ColourLayout{"rgb8", 3, {0, 1, 2}}, ColourLayout{"bgr8", 3, {2, 1, 0}},
    ColourLayout{"8uc3", 3, {2, 1, 0}}, // OpenCV's order
    ColourLayout{"rgba8", 4, {0, 1, 2}}, ColourLayout{"bgra8", 4, {2, 1, 0}},
    ColourLayout{"8uc4", 4, {2, 1, 0}}, ColourLayout{"rgb16", 6, {1, 3, 5}},
    ColourLayout{"bgr16", 6, {5, 3, 1}}, ColourLayout{"16uc3", 6, {5, 3, 1}},
    ColourLayout{"rgba16", 8, {1, 3, 5}}, ColourLayout{"bgra16", 8, {5, 3, 1}},
    ColourLayout{"mono8", 1, {0, 0, 0}}, ColourLayout{"8uc1", 1, {0, 0, 0}},
    ColourLayout{"gray", 1, {0, 0, 0}}, ColourLayout{"yuv422", 2, {}, Packing::Uyvy},
    ColourLayout{"uyvy", 2, {}, Packing::Uyvy}, ColourLayout{"yuv422_yuy2", 2, {}, Packing::Yuyv},
    ColourLayout{"yuyv", 2, {}, Packing::Yuyv}, ColourLayout{"yuy2", 2, {}, Packing::Yuyv},
    ColourLayout{"nv12", 1, {}, Packing::Nv12}, ColourLayout{"nv21", 1, {}, Packing::Nv21},
    ColourLayout{"i420", 1, {}, Packing::I420}, ColourLayout{"yv12", 1, {}, Packing::Yv12},
    // Offsets of red and blue in a cell of 2 x 2 pixels, row by row.
    ColourLayout{"bayer_rggb8", 1, {0, 0, 3}, Packing::Bayer},
    ColourLayout{"bayer_bggr8", 1, {3, 0, 0}, Packing::Bayer},
    ColourLayout{"bayer_gbrg8", 1, {2, 0, 1}, Packing::Bayer},
    ColourLayout{"bayer_grbg8", 1, {1, 0, 2}, Packing::Bayer},
    ColourLayout{"bayer_rggb16", 2, {0, 0, 3}, Packing::Bayer},
    ColourLayout{"bayer_bggr16", 2, {3, 0, 0}, Packing::Bayer},
    ColourLayout{"bayer_gbrg16", 2, {2, 0, 1}, Packing::Bayer},
    ColourLayout{"bayer_grbg16", 2, {1, 0, 2}, Packing::Bayer}};

uint32_t rgba(uint32_t r, uint32_t g, uint32_t b) {
    return r | g << 8 | b << 16 | 0xff000000u;
}

// word: Y0 U Y1 V from the least significant byte.
void putPair(uint32_t word, uint32_t x, uint32_t width, uint32_t* row) {
    const auto pair = rgbaOfYuyv(word);
    row[x] = pair[0];
    if (x + 1 < width) {
        row[x + 1] = pair[1];
    }
}

void packedRow(const uint8_t* in, const ColourLayout& layout, uint32_t width, uint32_t* out) {
    for (uint32_t x = 0; x < width; x += 2, in += 4) {
        const bool luma = layout.packing == Packing::Yuyv;
        putPair(luma ? uint32_t{in[0]} | uint32_t{in[1]} << 8 | uint32_t{in[2]} << 16 | uint32_t{in[3]} << 24
                     : uint32_t{in[1]} | uint32_t{in[0]} << 8 | uint32_t{in[3]} << 16 | uint32_t{in[2]} << 24,
                x, width, out);
    }
}

// Luma, then chroma of every 2 x 2 pixels: one plane of pairs, or two planes with rows of half the length.
class Planes {
public:
    Planes(const ColourImage& image, const ColourLayout& layout)
        : image_(image)
        , chromaRows_((size_t{image.height} + 1) / 2)
        , chromaStep_(layout.interleaved() ? image.step : (image.step + 1) / 2)
        , apart_(layout.interleaved() ? 2 : 1) {
        const size_t other = layout.interleaved() ? 1 : chromaRows_ * chromaStep_;
        const bool blueFirst = layout.packing == Packing::Nv12 || layout.packing == Packing::I420;
        blue_ = blueFirst ? 0 : other;
        red_ = blueFirst ? other : 0;
    }

    // `row`: bytes of the last one, behind which nothing is needed.
    size_t bytes(size_t row) const {
        const size_t luma = size_t{image_.height} * image_.step;
        return luma + (apart_ == 2 ? (chromaRows_ - 1) * chromaStep_ + row : 2 * chromaRows_ * chromaStep_);
    }
    void row(uint32_t y, uint32_t* out) const {
        const uint8_t* luma = image_.bytes.data() + size_t{y} * image_.step;
        const uint8_t* chroma =
            image_.bytes.data() + size_t{image_.height} * image_.step + (y / 2) * chromaStep_;
        for (uint32_t x = 0; x < image_.width; x += 2, chroma += apart_) {
            const uint32_t second = x + 1 < image_.width ? luma[x + 1] : luma[x];
            putPair(luma[x] | uint32_t{chroma[blue_]} << 8 | second << 16 | uint32_t{chroma[red_]} << 24, x,
                    image_.width, out);
        }
    }

private:
    const ColourImage& image_;
    size_t chromaRows_, chromaStep_, apart_; // [rows], [bytes] per row, [bytes] per sample
    size_t blue_ = 0, red_ = 0;              // [bytes] from the chroma's start
};

// Bilinear: the mean of the nearest samples of each colour. Edges repeat the pixel two columns or rows
// inside, which has the same filter.
class Mosaic {
public:
    Mosaic(const ColourImage& image, const ColourLayout& layout)
        : image_(image)
        , layout_(layout) {}

    uint32_t at(uint32_t x, uint32_t y) const {
        const int red = layout_.rgb[0], blue = layout_.rgb[2];
        const int here = static_cast<int>((y & 1) * 2 + (x & 1));
        const uint32_t own = sample(x, y);
        if (here == red || here == blue) {
            const uint32_t cross =
                (sample(x - 1, y) + sample(x + 1, y) + sample(x, y - 1) + sample(x, y + 1) + 2) / 4;
            const uint32_t corners = (sample(x - 1, y - 1) + sample(x + 1, y - 1) + sample(x - 1, y + 1) +
                                      sample(x + 1, y + 1) + 2) /
                                     4;
            return here == red ? rgba(own, cross, corners) : rgba(corners, cross, own);
        }
        const uint32_t beside = (sample(x - 1, y) + sample(x + 1, y) + 1) / 2;
        const uint32_t above = (sample(x, y - 1) + sample(x, y + 1) + 1) / 2;
        const bool redBeside = red / 2 == here / 2; // red is in this row
        return redBeside ? rgba(beside, own, above) : rgba(above, own, beside);
    }

private:
    uint32_t sample(uint32_t x, uint32_t y) const {
        const auto inside = [](uint32_t i, uint32_t count) {
            return i == UINT32_MAX ? std::min(1u, count - 1) : (i >= count ? (count < 2 ? 0 : count - 2) : i);
        };
        const size_t high = image_.bigEndian ? 0 : layout_.bytes - 1;
        const size_t column = size_t{inside(x, image_.width)} * layout_.bytes + high;
        return image_.bytes[size_t{inside(y, image_.height)} * image_.step + column];
    }
    const ColourImage& image_;
    const ColourLayout& layout_;
};

size_t rowBytes(const ColourLayout& layout, uint32_t width) {
    const bool pairs = layout.packing != Packing::Plain && layout.packing != Packing::Bayer;
    return size_t{layout.bytes} * (pairs ? (width + 1) / 2 * 2 : width);
}

// Offsets are those of the high bytes in little-endian channels; in big-endian ones they lie one lower.
void plainRow(const uint8_t* in, const ColourLayout& layout, bool bigEndian, uint32_t width, uint32_t* out) {
    const size_t lower = bigEndian && layout.wide() ? 1 : 0;
    for (uint32_t x = 0; x < width; ++x, in += layout.bytes) {
        out[x] = rgba(in[layout.rgb[0] - lower], in[layout.rgb[1] - lower], in[layout.rgb[2] - lower]);
    }
}

// The Orbbec SDK counts the bytes of all planes per row.
ColourImage withLumaStep(ColourImage image, const ColourLayout& layout) {
    const uint64_t all = (uint64_t{3} * image.width + 1) / 2;
    if (layout.planar() && image.step == all && image.bytes.size() == all * image.height) {
        image.step = image.width;
    }
    return image;
}

} // namespace

const ColourLayout* colourLayout(std::string encoding) {
    std::transform(encoding.begin(), encoding.end(), encoding.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto layout = std::find_if(kLayouts.begin(), kLayouts.end(),
                                     [&](const ColourLayout& one) { return encoding == one.encoding; });
    return layout == kLayouts.end() ? nullptr : &*layout;
}

std::string unpackColours(const ColourImage& given, const ColourLayout& layout, std::span<uint32_t> out) {
    const ColourImage image = withLumaStep(given, layout);
    const size_t row = rowBytes(layout, image.width);
    const Planes planes(image, layout);
    const uint64_t needed =
        layout.planar() ? planes.bytes(row) : (uint64_t{image.height} - 1) * image.step + row;
    if (image.height == 0 || image.step < row || image.bytes.size() < needed) {
        return "an image of " + std::to_string(image.bytes.size()) + " bytes in rows of " +
               std::to_string(image.step);
    }
    const Mosaic mosaic(image, layout);
    for (uint32_t y = 0; y < image.height; ++y) {
        const uint8_t* in = image.bytes.data() + size_t{y} * image.step;
        uint32_t* to = out.data() + size_t{y} * image.width;
        switch (layout.packing) {
        case Packing::Plain:
            plainRow(in, layout, image.bigEndian, image.width, to);
            break;
        case Packing::Uyvy:
        case Packing::Yuyv:
            packedRow(in, layout, image.width, to);
            break;
        case Packing::Nv12:
        case Packing::Nv21:
        case Packing::I420:
        case Packing::Yv12:
            planes.row(y, to);
            break;
        case Packing::Bayer:
            for (uint32_t x = 0; x < image.width; ++x) {
                to[x] = mosaic.at(x, y);
            }
            break;
        }
    }
    return "";
}

} // namespace fathom::ros
