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
    ColourLayout{"yuv422", 2, {}, Packing::Uyvy}, ColourLayout{"uyvy", 2, {}, Packing::Uyvy},
    ColourLayout{"yuv422_yuy2", 2, {}, Packing::Yuyv}, ColourLayout{"yuyv", 2, {}, Packing::Yuyv},
    ColourLayout{"nv12", 1, {}, Packing::Nv12}, ColourLayout{"nv21", 1, {}, Packing::Nv21},
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

void planarRow(const uint8_t* luma, const uint8_t* chroma, bool blueFirst, uint32_t width, uint32_t* out) {
    for (uint32_t x = 0; x < width; x += 2) {
        const uint32_t second = x + 1 < width ? luma[x + 1] : luma[x];
        const uint32_t u = chroma[x + (blueFirst ? 0 : 1)], v = chroma[x + (blueFirst ? 1 : 0)];
        putPair(luma[x] | u << 8 | second << 16 | v << 24, x, width, out);
    }
}

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

} // namespace

const ColourLayout* colourLayout(std::string encoding) {
    std::transform(encoding.begin(), encoding.end(), encoding.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto layout = std::find_if(kLayouts.begin(), kLayouts.end(),
                                     [&](const ColourLayout& one) { return encoding == one.encoding; });
    return layout == kLayouts.end() ? nullptr : &*layout;
}

std::string unpackColours(const ColourImage& image, const ColourLayout& layout, std::span<uint32_t> out) {
    const size_t row = rowBytes(layout, image.width);
    const bool planar = layout.packing == Packing::Nv12 || layout.packing == Packing::Nv21;
    const uint64_t rows = uint64_t{image.height} + (planar ? (image.height + 1) / 2 : 0);
    if (rows == 0 || image.step < row || image.bytes.size() < (rows - 1) * image.step + row) {
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
            planarRow(in, image.bytes.data() + (size_t{image.height} + y / 2) * image.step,
                      layout.packing == Packing::Nv12, image.width, to);
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
