// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/colour_rows.h"

#include "engine/types/lower_case.h"

#include <algorithm>

namespace fathom::ros {

namespace {

constexpr ColourLayout rawLayout(const char* encoding, RawKind kind) {
    return {.encoding = encoding, .raw = kind};
}

constexpr std::array kLayouts{
    rawLayout("rgb8", RawKind::Rgb), rawLayout("bgr8", RawKind::Bgr),
    rawLayout("8uc3", RawKind::Bgr), // OpenCV's order
    ColourLayout{"rgba8", 4, {0, 1, 2}}, ColourLayout{"bgra8", 4, {2, 1, 0}},
    ColourLayout{"8uc4", 4, {2, 1, 0}}, ColourLayout{"rgb16", 6, {1, 3, 5}},
    ColourLayout{"bgr16", 6, {5, 3, 1}}, ColourLayout{"16uc3", 6, {5, 3, 1}},
    ColourLayout{"rgba16", 8, {1, 3, 5}}, ColourLayout{"bgra16", 8, {5, 3, 1}},
    ColourLayout{"mono8", 1, {0, 0, 0}}, ColourLayout{"8uc1", 1, {0, 0, 0}},
    ColourLayout{"gray", 1, {0, 0, 0}}, rawLayout("yuv422", RawKind::Uyvy), rawLayout("uyvy", RawKind::Uyvy),
    rawLayout("yuv422_yuy2", RawKind::Yuyv), rawLayout("yuyv", RawKind::Yuyv),
    rawLayout("yuy2", RawKind::Yuyv), rawLayout("nv12", RawKind::Nv12), rawLayout("nv21", RawKind::Nv21),
    rawLayout("i420", RawKind::I420), rawLayout("yv12", RawKind::Yv12),
    // Offsets of red and blue in a cell of 2 x 2 pixels, row by row.
    ColourLayout{"bayer_rggb8", 1, {0, 0, 3}, true}, ColourLayout{"bayer_bggr8", 1, {3, 0, 0}, true},
    ColourLayout{"bayer_gbrg8", 1, {2, 0, 1}, true}, ColourLayout{"bayer_grbg8", 1, {1, 0, 2}, true},
    ColourLayout{"bayer_rggb16", 2, {0, 0, 3}, true}, ColourLayout{"bayer_bggr16", 2, {3, 0, 0}, true},
    ColourLayout{"bayer_gbrg16", 2, {2, 0, 1}, true}, ColourLayout{"bayer_grbg16", 2, {1, 0, 2}, true}};

uint32_t rgba(uint32_t r, uint32_t g, uint32_t b) {
    return r | g << 8 | b << 16 | 0xff000000u;
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

// Offsets are those of the high bytes in little-endian channels; in big-endian ones they lie one lower.
void plainRow(const uint8_t* in, const ColourLayout& layout, bool bigEndian, uint32_t width, uint32_t* out) {
    const size_t lower = bigEndian && layout.wide() ? 1 : 0;
    for (uint32_t x = 0; x < width; ++x, in += layout.bytes) {
        out[x] = rgba(in[layout.rgb[0] - lower], in[layout.rgb[1] - lower], in[layout.rgb[2] - lower]);
    }
}

} // namespace

const ColourLayout* colourLayout(const std::string& encoding) {
    const std::string name = lowerCase(encoding);
    const auto layout = std::ranges::find(kLayouts, name, &ColourLayout::encoding);
    return layout == kLayouts.end() ? nullptr : &*layout;
}

std::string unpackColours(const ColourImage& image, const ColourLayout& layout, std::span<uint32_t> out) {
    const size_t row = size_t{layout.bytes} * image.width;
    const uint64_t needed = (uint64_t{image.height} - 1) * image.step + row;
    if (image.height == 0 || image.step < row || image.bytes.size() < needed) {
        return "an image of " + std::to_string(image.bytes.size()) + " bytes in rows of " +
               std::to_string(image.step);
    }
    const Mosaic mosaic(image, layout);
    for (uint32_t y = 0; y < image.height; ++y) {
        uint32_t* to = out.data() + size_t{y} * image.width;
        if (!layout.bayer) {
            plainRow(image.bytes.data() + size_t{y} * image.step, layout, image.bigEndian, image.width, to);
        }
        for (uint32_t x = 0; layout.bayer && x < image.width; ++x) {
            to[x] = mosaic.at(x, y);
        }
    }
    return "";
}

std::string copyColours(const ColourImage& image, const ColourLayout& layout, std::span<std::byte> out,
                        RawColour& raw) {
    RawImage source{*layout.raw, image.width, image.height, image.step, std::as_bytes(image.bytes)};
    // The Orbbec SDK counts the bytes of all planes per row.
    const uint64_t all = (uint64_t{3} * image.width + 1) / 2;
    if (formatOf(*layout.raw) == ColourFormat::Planes && image.step == all &&
        image.bytes.size() == all * image.height) {
        source.step = image.width;
    }
    return image.step == 0 ? "rows of 0 bytes" : copyRaw(source, out, raw);
}

} // namespace fathom::ros
