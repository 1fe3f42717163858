// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/pixel_format.h"

#include "devices/v4l2/jpeg_image.h"
#include "engine/types/yuyv.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fathom {

namespace {

constexpr uint32_t kZ16 = fourccOf("Z16 "), kInzi = fourccOf("INZI"), kY16 = fourccOf("Y16 "),
                   kY12 = fourccOf("Y12 "), kY10 = fourccOf("Y10 "), kY10b = fourccOf("Y10B"),
                   kYuyv = fourccOf("YUYV"), kUyvy = fourccOf("UYVY"), kRgb3 = fourccOf("RGB3"),
                   kBgr3 = fourccOf("BGR3"), kMjpg = fourccOf("MJPG"), kJpeg = fourccOf("JPEG");

constexpr std::array kDeclared{kZ16, kInzi};
constexpr std::array kColour{kRgb3, kBgr3, kYuyv, kUyvy, kMjpg, kJpeg};

uint32_t rgba(uint32_t r, uint32_t g, uint32_t b) {
    return r | g << 8 | b << 16 | 0xff000000u;
}

uint32_t yuyvWord(const uint8_t* in, bool lumaFirst) {
    uint32_t word;
    std::memcpy(&word, in, sizeof word);
    return lumaFirst ? word : (word >> 8 & 0x00ff00ffu) | (word & 0x00ff00ffu) << 8;
}

void yuvRow(const uint8_t* in, uint32_t width, bool lumaFirst, uint32_t* out) {
    for (uint32_t x = 0; x < width; x += 2, in += 4) {
        const auto pair = rgbaOfYuyv(yuyvWord(in, lumaFirst));
        out[x] = pair[0];
        if (x + 1 < width) { // the second pixel of the last pair may be outside
            out[x + 1] = pair[1];
        }
    }
}

void rgbRow(const uint8_t* in, uint32_t width, bool redFirst, uint32_t* out) {
    for (uint32_t x = 0; x < width; ++x, in += 3) {
        out[x] = rgba(in[redFirst ? 0 : 2], in[1], in[redFirst ? 2 : 0]);
    }
}

uint32_t leastStride(uint32_t fourcc, uint32_t width) {
    if (const auto layout = depthLayout(fourcc)) {
        return layout->rowBytes(width, 0);
    }
    if (fourcc == kYuyv || fourcc == kUyvy) {
        return (width + 1) / 2 * 4;
    }
    return fourcc == kRgb3 || fourcc == kBgr3 ? 3 * width : 0;
}

} // namespace

uint32_t DepthLayout::rowBytes(uint32_t width, uint32_t stride) const {
    const uint32_t least = (width * bitsPerPixel + 7) / 8;
    return planesBefore > 0 ? least : std::max(stride, least);
}

std::optional<DepthLayout> depthLayout(uint32_t fourcc) {
    switch (fourcc) {
    case kZ16:
    case kY16:
        return DepthLayout{};
    case kInzi:
        return DepthLayout{.planesBefore = 1};
    case kY12:
        return DepthLayout{.mask = 0x0fff};
    case kY10:
        return DepthLayout{.mask = 0x03ff};
    case kY10b:
        return DepthLayout{.bitsPerPixel = 10, .packed = true, .mask = 0x03ff};
    default:
        return std::nullopt;
    }
}

std::span<const uint32_t> declaredDepthFormats() {
    return kDeclared;
}

std::span<const uint32_t> colourFormats() {
    return kColour;
}

bool isYuyv(uint32_t fourcc) {
    return fourcc == kYuyv || fourcc == kUyvy;
}

size_t imageBytes(uint32_t fourcc, VideoSize size, uint32_t stride) {
    const size_t row = leastStride(fourcc, size.width);
    if (row == 0 || size.height == 0) {
        return 0;
    }
    const auto layout = depthLayout(fourcc);
    const size_t rows = size_t{size.height} * (1 + (layout ? layout->planesBefore : 0));
    const size_t apart = layout ? layout->rowBytes(size.width, stride) : std::max<size_t>(stride, row);
    return (rows - 1) * apart + row;
}

void unpackDepth(const DepthLayout& layout, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                 std::span<uint16_t> out) {
    const size_t row = layout.rowBytes(size.width, stride);
    const auto* in = reinterpret_cast<const uint8_t*>(bytes.data()) + row * size.height * layout.planesBefore;
    for (uint32_t y = 0; y < size.height; ++y, in += row) {
        uint16_t* to = out.data() + size_t{y} * size.width;
        for (uint32_t x = 0; x < size.width; ++x) {
            if (layout.packed) {
                const uint32_t bit = 10 * x;
                const uint8_t* at = in + bit / 8;
                to[x] = static_cast<uint16_t>((at[0] << 8 | at[1]) >> (6 - bit % 8) & layout.mask);
            } else {
                to[x] = static_cast<uint16_t>((in[2 * x] | in[2 * x + 1] << 8) & layout.mask);
            }
        }
    }
}

namespace {

// Returns the fault; empty when it is complete.
std::string shortColour(uint32_t fourcc, VideoSize size, uint32_t stride, std::span<const std::byte> bytes) {
    const size_t wanted = imageBytes(fourcc, size, stride);
    if (wanted == 0 || depthLayout(fourcc)) {
        return "not a colour format: " + fourccName(fourcc);
    }
    return bytes.size() >= wanted ? ""
                                  : "a colour image of " + std::to_string(bytes.size()) + " bytes, " +
                                        std::to_string(wanted) + " make one";
}

} // namespace

std::string unpackColour(uint32_t fourcc, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                         std::span<uint32_t> out) {
    if (fourcc == kMjpg || fourcc == kJpeg) {
        return readJpeg(bytes, size, out);
    }
    if (const std::string fault = shortColour(fourcc, size, stride, bytes); !fault.empty()) {
        return fault;
    }
    const size_t row = std::max(stride, leastStride(fourcc, size.width));
    for (uint32_t y = 0; y < size.height; ++y) {
        const auto* in = reinterpret_cast<const uint8_t*>(bytes.data()) + row * y;
        uint32_t* to = out.data() + size_t{y} * size.width;
        if (fourcc == kRgb3 || fourcc == kBgr3) {
            rgbRow(in, size.width, fourcc == kRgb3, to);
        } else {
            yuvRow(in, size.width, fourcc == kYuyv, to);
        }
    }
    return "";
}

std::string copyYuyv(uint32_t fourcc, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                     std::span<uint32_t> out) {
    if (const std::string fault = shortColour(fourcc, size, stride, bytes); !fault.empty()) {
        return fault;
    }
    const size_t row = std::max(stride, leastStride(fourcc, size.width)), words = size.width / 2;
    for (uint32_t y = 0; y < size.height; ++y) {
        const auto* in = reinterpret_cast<const uint8_t*>(bytes.data()) + row * y;
        uint32_t* to = out.data() + y * words;
        for (size_t i = 0; i < words; ++i) {
            to[i] = yuyvWord(in + 4 * i, fourcc == kYuyv);
        }
    }
    return "";
}

} // namespace fathom
