// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/pixel_format.h"

#include "devices/images/raw_image.h"
#include "devices/v4l2/jpeg_image.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fathom {

namespace {

constexpr uint32_t kZ16 = fourccOf("Z16 "), kInzi = fourccOf("INZI"), kY16 = fourccOf("Y16 "),
                   kY12 = fourccOf("Y12 "), kY10 = fourccOf("Y10 "), kY10b = fourccOf("Y10B"),
                   kYuyv = fourccOf("YUYV"), kUyvy = fourccOf("UYVY"), kRgb3 = fourccOf("RGB3"),
                   kBgr3 = fourccOf("BGR3"), kNv12 = fourccOf("NV12"), kMjpg = fourccOf("MJPG"),
                   kJpeg = fourccOf("JPEG");

constexpr std::array kDeclared{kZ16, kInzi};
constexpr std::array kColour{kRgb3, kBgr3, kYuyv, kUyvy, kNv12, kMjpg, kJpeg};

// Uncompressed formats of colour.
std::optional<RawKind> rawKindOf(uint32_t fourcc) {
    constexpr std::array kKinds{std::pair(kRgb3, RawKind::Rgb), std::pair(kBgr3, RawKind::Bgr),
                                std::pair(kYuyv, RawKind::Yuyv), std::pair(kUyvy, RawKind::Uyvy),
                                std::pair(kNv12, RawKind::Nv12)};
    const auto found = std::ranges::find(kKinds, fourcc, &std::pair<uint32_t, RawKind>::first);
    return found == kKinds.end() ? std::nullopt : std::optional(found->second);
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

ColourFormat colourFormatOf(uint32_t fourcc) {
    const auto kind = rawKindOf(fourcc);
    return kind ? formatOf(*kind) : ColourFormat::JpegPlanes;
}

size_t imageBytes(uint32_t fourcc, VideoSize size, uint32_t stride) {
    if (const auto kind = rawKindOf(fourcc)) {
        return neededBytes({*kind, size.width, size.height, stride, {}});
    }
    const auto layout = depthLayout(fourcc);
    if (!layout || size.height == 0) {
        return 0;
    }
    const size_t rows = size_t{size.height} * (1 + layout->planesBefore);
    return (rows - 1) * layout->rowBytes(size.width, stride) + layout->rowBytes(size.width, 0);
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

std::string copyColour(uint32_t fourcc, VideoSize size, uint32_t stride, std::span<const std::byte> bytes,
                       std::span<std::byte> out, RawColour& raw) {
    if (fourcc == kMjpg || fourcc == kJpeg) {
        return readJpeg(bytes, size, out, raw);
    }
    const auto kind = rawKindOf(fourcc);
    return kind ? copyRaw({*kind, size.width, size.height, stride, bytes}, out, raw)
                : "not a colour format: " + fourccName(fourcc);
}

} // namespace fathom
