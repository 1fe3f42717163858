// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/image_pixels.h"

#include "devices/bag/colour_rows.h"
#include "devices/bag/compressed_colour.h"
#include "devices/bag/compressed_depth.h"
#include "devices/recorded/png_image.h"
#include "devices/v4l2/jpeg_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <strings.h>
#include <vector>

namespace fathom::ros {

namespace {

// As ROS spells it: SDKs and drivers write "Z16" and "16uc1", too.
std::string depthEncoding(const std::string& encoding) {
    constexpr std::array<const char*, 5> kDepth{"16UC1", "mono16", "32FC1", "z16", "rvl"};
    const auto known = std::ranges::find_if(
        kDepth, [&](const char* name) { return strcasecmp(name, encoding.c_str()) == 0; });
    return known == kDepth.end() ? "" : *known;
}

CompressedDepth packed(const Image& image) {
    return {image.data, image.format.find("rvl") != std::string::npos};
}

CompressedColour packedColour(const Image& image) {
    return {image.data, image.encoding, image.format};
}

// By its format, or by its content where a bridge states only "png".
bool isCompressedDepth(const Image& image) {
    return image.format.find("compressedDepth") != std::string::npos || packed(image).holdsPng();
}

std::string checkBytes(const Image& image, size_t row) {
    if (image.height == 0 || image.step < row ||
        image.data.size() < size_t{image.step} * (image.height - 1) + row) {
        return "an image of " + std::to_string(image.data.size()) + " bytes in rows of " +
               std::to_string(image.step);
    }
    return "";
}

float floatAt(const Image& image, uint32_t x, uint32_t y, bool bigEndian) {
    uint32_t bits = 0;
    std::memcpy(&bits, image.data.data() + size_t{y} * image.step + size_t{4} * x, 4);
    return std::bit_cast<float>(bigEndian ? __builtin_bswap32(bits) : bits);
}

ByteOrder orderOfMetres(const Image& image) {
    OrderOfReals order;
    for (uint32_t y = 0; y < image.height; ++y) {
        for (uint32_t x = 0; x < image.width; ++x) {
            order.add(double{floatAt(image, x, y, image.bigEndian)},
                      double{floatAt(image, x, y, !image.bigEndian)});
        }
    }
    return order.order();
}

std::string compressedDepthRows(const Image& image, double metresPerUnit, std::span<uint16_t> out,
                                uint64_t& beyond) {
    const auto size = sizeOf(image);
    if (!size) {
        return "a compressed image without a header that is read";
    }
    if (!isCompressedDepth(image)) {
        return readDepthPng(image.data, {size->first, size->second}, out);
    }
    const CompressedDepth depth = packed(image);
    if (holdsMetres(image) && !depth.rvl && !depth.holdsPng()) {
        return "a compressed image of 32FC1 without the header that holds its scale";
    }
    const std::string fault = depth.values(size->first, size->second, out);
    if (!fault.empty() || !holdsMetres(image)) {
        return fault;
    }
    for (uint16_t& value : out.first(size_t{size->first} * size->second)) {
        value = unitsOf(depth.metres(value), metresPerUnit, beyond);
    }
    return "";
}

// Bytes of a row without gaps; 0 for several planes, and unknown encodings.
uint64_t rowBytes(const Image& image) {
    const std::string depth = depthEncoding(image.encoding);
    if (!depth.empty()) {
        return depth == "rvl" ? 0 : uint64_t{image.width} * (depth == "32FC1" ? 4 : 2);
    }
    const ColourLayout* layout = colourLayout(image.encoding);
    if (layout == nullptr || !layout->raw) {
        return layout == nullptr ? 0 : uint64_t{image.width} * layout->bytes;
    }
    switch (*layout->raw) {
    case RawKind::Rgb:
    case RawKind::Bgr:
        return uint64_t{image.width} * 3;
    case RawKind::Uyvy:
    case RawKind::Yuyv:
        return uint64_t{image.width} * 2;
    default:
        return 0;
    }
}

} // namespace

std::string correctStep(Image& image) {
    const uint64_t row = image.compressed ? 0 : rowBytes(image);
    if (row == 0 || image.data.size() != row * image.height || checkBytes(image, row).empty()) {
        return "";
    }
    const std::string stated = statedRows(image.step, row);
    image.step = static_cast<uint32_t>(row);
    return stated;
}

Content content(const Image& image) {
    const ColourLayout* layout = colourLayout(image.encoding);
    if (!image.compressed) {
        return !depthEncoding(image.encoding).empty() ? Content::Depth
               : layout == nullptr                    ? Content::None
               : layout->grey()                       ? Content::Grey
                                                      : Content::Colour;
    }
    if (isCompressedDepth(image)) {
        return Content::Depth;
    }
    const CompressedColour colour = packedColour(image);
    if (colour.holdsMosaic()) {
        return Content::Colour;
    }
    const auto png = pngHeader(image.data);
    if (png && png->grey) {
        return png->bits == 16 ? Content::Depth : Content::Grey;
    }
    if (!png && !isJpeg(std::as_bytes(image.data))) {
        return Content::None;
    }
    return colour.isGrey() || (layout != nullptr && layout->grey()) ? Content::Grey : Content::Colour;
}

std::optional<std::pair<uint32_t, uint32_t>> sizeOf(const Image& image) {
    if (!image.compressed) {
        return std::pair(image.width, image.height);
    }
    if (isCompressedDepth(image)) {
        return packed(image).size();
    }
    if (const auto png = pngHeader(image.data)) {
        return std::pair(png->size.width, png->size.height);
    }
    const auto jpeg = jpegHeader(std::as_bytes(image.data));
    return jpeg ? std::optional(std::pair(jpeg->size.width, jpeg->size.height)) : std::nullopt;
}

// A format without encoding leaves that to the header of the compressed image.
bool holdsMetres(const Image& image) {
    const std::string encoding = depthEncoding(image.encoding);
    return encoding == "32FC1" ? !image.compressed || isCompressedDepth(image)
                               : encoding.empty() && image.compressed && isCompressedDepth(image) &&
                                     packed(image).quantised();
}

std::string depthRows(const Image& image, double metresPerUnit, std::span<uint16_t> out, uint64_t& beyond) {
    if (image.compressed) {
        return compressedDepthRows(image, metresPerUnit, out, beyond);
    }
    if (depthEncoding(image.encoding) == "rvl") { // the values alone
        return unpackRvl(image.data, out.first(size_t{image.width} * image.height)) ? "" : "RVL: damaged";
    }
    const bool metres = holdsMetres(image);
    const std::string fault = checkBytes(image, size_t{image.width} * (metres ? 4 : 2));
    for (uint32_t y = 0; fault.empty() && y < image.height; ++y) {
        uint16_t* to = out.data() + size_t{y} * image.width;
        if (!metres) {
            std::memcpy(to, image.data.data() + size_t{y} * image.step, size_t{2} * image.width);
            if (image.bigEndian) {
                std::transform(to, to + image.width, to, [](uint16_t v) { return __builtin_bswap16(v); });
            }
        }
        for (uint32_t x = 0; metres && x < image.width; ++x) {
            to[x] = unitsOf(double{floatAt(image, x, y, image.bigEndian)}, metresPerUnit, beyond);
        }
    }
    return fault;
}

ByteOrder depthOrder(const Image& image) {
    const std::string encoding = image.compressed ? "" : depthEncoding(image.encoding);
    const bool metres = encoding == "32FC1";
    if (encoding.empty() || encoding == "rvl" ||
        !checkBytes(image, size_t{image.width} * (metres ? 4 : 2)).empty()) {
        return ByteOrder::Unknown;
    }
    if (metres) {
        return orderOfMetres(image);
    }
    std::vector<uint16_t> values(size_t{image.width} * image.height);
    uint64_t beyond = 0;
    return depthRows(image, 1.0, values, beyond).empty() ? orderOfUnits(values, image.width)
                                                         : ByteOrder::Unknown;
}

ColourFormat colourFormat(const Image& image) {
    if (image.compressed) {
        return packedColour(image).colourFormat();
    }
    const ColourLayout* layout = colourLayout(image.encoding);
    return layout != nullptr && layout->raw ? formatOf(*layout->raw) : ColourFormat::Rgba;
}

std::string colourRows(const Image& image, std::span<uint32_t> out, RawColour& raw) {
    const auto size = sizeOf(image);
    if (image.compressed && size) {
        return packedColour(image).rows(size->first, size->second, out, raw);
    }
    const ColourLayout* layout = colourLayout(image.encoding);
    if (layout == nullptr) {
        return "encoding " + image.encoding;
    }
    const ColourImage pixels{image.width, image.height, image.step, image.data, image.bigEndian};
    return layout->raw ? copyColours(pixels, *layout, std::as_writable_bytes(out), raw)
                       : unpackColours(pixels, *layout, out);
}

ValueSpan valueSpan(const Image& image) {
    ValueSpan span;
    if (image.compressed) {
        const auto size = sizeOf(image);
        constexpr uint64_t kMax = 3840ull * 2160;
        if (!size || uint64_t{size->first} * size->second > kMax) {
            return span;
        }
        std::vector<uint16_t> stored(size_t{size->first} * size->second);
        const CompressedDepth depth = packed(image);
        if (depth.values(size->first, size->second, stored).empty()) {
            std::for_each(stored.begin(), stored.end(), [&](uint16_t v) { span.add(depth.metres(v)); });
        }
        return span;
    }
    for (uint32_t y = 0; checkBytes(image, size_t{4} * image.width).empty() && y < image.height; ++y) {
        for (uint32_t x = 0; x < image.width; ++x) {
            span.add(double{floatAt(image, x, y, image.bigEndian)});
        }
    }
    return span;
}

} // namespace fathom::ros
