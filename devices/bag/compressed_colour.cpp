// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/compressed_colour.h"

#include "devices/bag/colour_rows.h"
#include "devices/recorded/png_image.h"
#include "devices/v4l2/jpeg_image.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fathom {

bool CompressedColour::isGrey() const {
    if (const auto png = pngHeader(data)) {
        return png->grey;
    }
    const auto jpeg = jpegHeader(std::as_bytes(data));
    return jpeg && jpeg->grey;
}

bool CompressedColour::holdsMosaic() const {
    const ros::ColourLayout* layout = ros::colourLayout(encoding);
    return layout != nullptr && layout->bayer && isGrey();
}

ColourFormat CompressedColour::format() const {
    return pngHeader(data) || holdsMosaic() ? ColourFormat::Rgba : ColourFormat::JpegPlanes;
}

std::string CompressedColour::rows(uint32_t width, uint32_t height, std::span<uint32_t> out,
                                   RawColour& raw) const {
    if (holdsMosaic()) {
        return mosaicRows(width, height, out);
    }
    return pngHeader(data) ? readColourPng(data, {width, height}, out)
                           : readJpeg(std::as_bytes(data), {width, height}, std::as_writable_bytes(out), raw);
}

std::string CompressedColour::mosaicRows(uint32_t width, uint32_t height, std::span<uint32_t> out) const {
    ros::ColourLayout layout = *ros::colourLayout(encoding);
    layout.bytes = 1; // decoded to 8 bits
    std::vector<uint8_t> samples(mostColourBytes(ColourFormat::JpegPlanes, width, height));
    uint32_t step = width;
    std::string fault;
    if (pngHeader(data)) {
        fault = readColourPng(data, {width, height}, out);
        std::ranges::transform(out.first(size_t{width} * height), samples.begin(),
                               [](uint32_t pixel) { return static_cast<uint8_t>(pixel & 0xffu); });
    } else {
        RawColour planes;
        fault = readJpeg(std::as_bytes(data), {width, height}, std::as_writable_bytes(std::span(samples)),
                         planes);
        step = planes.planes.lumaStep;
    }
    return fault.empty() ? ros::unpackColours({width, height, step, samples}, layout, out) : fault;
}

} // namespace fathom
