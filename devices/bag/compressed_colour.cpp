// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/compressed_colour.h"

#include "devices/bag/colour_rows.h"
#include "devices/recorded/png_image.h"
#include "devices/v4l2/jpeg_image.h"
#include "engine/types/lower_case.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace fathom {

RedAndBlue redAndBlue(const std::string& format) {
    const std::string text = lowerCase(format);
    const size_t split = text.find(';');
    if (split == std::string::npos || !(text.starts_with("rgb") || text.starts_with("bgr"))) {
        return RedAndBlue::AsUsual;
    }
    return text.find("compressed bgr", split) != std::string::npos   ? RedAndBlue::AsUsual
           : text.find("compressed rgb", split) != std::string::npos ? RedAndBlue::Swapped
                                                                     : RedAndBlue::Doubtful;
}

std::string redAndBlueWarning(const std::string& format) {
    switch (redAndBlue(format)) {
    case RedAndBlue::Swapped:
        return "the format '" + format +
               "' states that red and blue are stored swapped: they are read as compressed_image_transport "
               "does";
    case RedAndBlue::Doubtful:
        return "the format '" + format +
               "' names neither 'compressed bgr8' nor 'compressed rgb8': red and blue may be swapped";
    case RedAndBlue::AsUsual:
        break;
    }
    return "";
}

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

ColourFormat CompressedColour::colourFormat() const {
    const bool onHost = pngHeader(data) || holdsMosaic() || redAndBlue(format) == RedAndBlue::Swapped;
    return onHost ? ColourFormat::Rgba : ColourFormat::JpegPlanes;
}

std::string CompressedColour::rows(uint32_t width, uint32_t height, std::span<uint32_t> out,
                                   RawColour& raw) const {
    if (colourFormat() == ColourFormat::JpegPlanes) {
        return readJpeg(std::as_bytes(data), {width, height}, std::as_writable_bytes(out), raw);
    }
    const std::span<uint32_t> pixels = out.first(size_t{width} * height);
    const std::string fault = rgbaRows(width, height, pixels);
    if (!fault.empty()) {
        return fault;
    }
    if (holdsMosaic()) {
        return mosaicRows(width, height, pixels);
    }
    if (redAndBlue(format) == RedAndBlue::Swapped) {
        std::ranges::transform(pixels, pixels.begin(), [](uint32_t pixel) {
            return (pixel & 0xff00ff00u) | (pixel & 0xffu) << 16u | (pixel >> 16u & 0xffu);
        });
    }
    return "";
}

std::string CompressedColour::rgbaRows(uint32_t width, uint32_t height, std::span<uint32_t> out) const {
    if (pngHeader(data)) {
        return readColourPng(data, {width, height}, out);
    }
    std::vector<std::byte> memory(mostColourBytes(ColourFormat::JpegPlanes, width, height));
    RawColour planes;
    std::string fault = readJpeg(std::as_bytes(data), {width, height}, memory, planes);
    if (fault.empty()) {
        unpackColour(planes, out);
    }
    return fault;
}

// out: the mosaic as grey.
std::string CompressedColour::mosaicRows(uint32_t width, uint32_t height, std::span<uint32_t> out) const {
    ros::ColourLayout layout = *ros::colourLayout(encoding);
    layout.bytes = 1; // decoded to 8 bits
    std::vector<uint8_t> samples;
    samples.reserve(out.size());
    std::ranges::transform(out, std::back_inserter(samples),
                           [](uint32_t pixel) { return static_cast<uint8_t>(pixel & 0xffu); });
    return ros::unpackColours({width, height, width, samples}, layout, out);
}

} // namespace fathom
