// SPDX-License-Identifier: Apache-2.0
#include "devices/images/raw_image.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fathom {

namespace {

// Rows of equal length in the image.
struct RawPlane {
    size_t from = 0, step = 0, row = 0, rows = 0; // [bytes]; `rows`: their number
};

bool hasPlanes(RawKind kind) {
    return kind >= RawKind::Nv12;
}

bool inPairs(RawKind kind) {
    return kind == RawKind::Nv12 || kind == RawKind::Nv21;
}

std::array<RawPlane, 3> planesOf(const RawImage& image) {
    const size_t w = image.width, h = image.height, pairs = (w + 1) / 2, down = (h + 1) / 2;
    if (!hasPlanes(image.kind)) {
        const size_t row = mostColourBytes(formatOf(image.kind), image.width, 1);
        return {RawPlane{0, std::max<size_t>(row, image.step), row, h}};
    }
    const size_t step = std::max<size_t>(w, image.step);
    const RawPlane luma{0, step, w, h};
    if (inPairs(image.kind)) {
        return {luma, RawPlane{h * step, std::max(step, 2 * pairs), 2 * pairs, down}};
    }
    const size_t half = (step + 1) / 2;
    return {luma, RawPlane{h * step, half, pairs, down}, RawPlane{h * step + down * half, half, pairs, down}};
}

// Of the copy without gaps.
ColourPlanes placesOf(RawKind kind, uint32_t width, uint32_t height) {
    const uint32_t luma = width * height, pairs = (width + 1) / 2;
    const bool paired = inPairs(kind), blueFirst = kind == RawKind::Nv12 || kind == RawKind::I420;
    const uint32_t second = luma + (paired ? 1 : pairs * ((height + 1) / 2));
    ColourPlanes places;
    places.lumaStep = width;
    places.blue = blueFirst ? luma : second;
    places.red = blueFirst ? second : luma;
    places.chromaStep = paired ? 2 * pairs : pairs;
    places.across = places.down = 1;
    places.apart = paired ? 1 : 0;
    return places;
}

} // namespace

ColourFormat formatOf(RawKind kind) {
    constexpr std::array kFormats{ColourFormat::Rgb, ColourFormat::Bgr, ColourFormat::Yuyv,
                                  ColourFormat::Uyvy};
    return hasPlanes(kind) ? ColourFormat::Planes : kFormats[static_cast<size_t>(kind)];
}

size_t neededBytes(const RawImage& image) {
    const size_t row =
        hasPlanes(image.kind) ? image.width : mostColourBytes(formatOf(image.kind), image.width, 1);
    if (image.width == 0 || image.height == 0 || (image.step != 0 && image.step < row)) {
        return 0;
    }
    size_t end = 0;
    for (const RawPlane& plane : planesOf(image)) {
        end = plane.rows > 0 ? std::max(end, plane.from + (plane.rows - 1) * plane.step + plane.row) : end;
    }
    return end;
}

std::string copyRaw(const RawImage& image, std::span<std::byte> out, RawColour& raw) {
    const size_t needed = neededBytes(image);
    if (needed == 0 || image.bytes.size() < needed) {
        return "a colour image of " + std::to_string(image.bytes.size()) + " bytes, " +
               (needed == 0 ? "in rows of " + std::to_string(image.step)
                            : std::to_string(needed) + " make one");
    }
    std::byte* to = out.data();
    for (const RawPlane& plane : planesOf(image)) {
        const std::byte* from = image.bytes.data() + plane.from;
        if (plane.step == plane.row) {
            std::memcpy(to, from, plane.rows * plane.row);
            to += plane.rows * plane.row;
            continue;
        }
        for (size_t y = 0; y < plane.rows; ++y, from += plane.step, to += plane.row) {
            std::memcpy(to, from, plane.row);
        }
    }
    raw = {formatOf(image.kind), image.width, image.height, out.first(static_cast<size_t>(to - out.data())),
           placesOf(image.kind, image.width, image.height)};
    return "";
}

} // namespace fathom
