// SPDX-License-Identifier: Apache-2.0
// Colour images as compressed_image_transport publishes them: JPEG or PNG of their colours, of grey or of the
// mosaic of a Bayer camera.
#pragma once

#include "engine/types/colour_format.h"

#include <cstdint>
#include <span>
#include <string>

namespace fathom {

// What the format of a CompressedImage states about red and blue, as the subscriber of
// compressed_image_transport reads it: "rgb8; jpeg compressed bgr8" is as usual, "rgb8; jpeg compressed rgb8"
// has them swapped.
enum class RedAndBlue { AsUsual, Swapped, Doubtful };
RedAndBlue redAndBlue(const std::string& format);
// The warning for another order than usual; else empty.
std::string redAndBlueWarning(const std::string& format);

// encoding: of the image before it was compressed ("bayer_rggb8"); empty or unknown = not stated. format: the
// whole text of the message, which begins with it.
struct CompressedColour {
    std::span<const uint8_t> data;
    std::string encoding, format = {};

    // Whether it is a JPEG or PNG of one component, by its header.
    bool isGrey() const;
    // Whether its only component is a mosaic.
    bool holdsMosaic() const;
    // How rows() leaves it.
    ColourFormat colourFormat() const;
    // As ros::colourRows() of an image whose header states this size [pixels].
    std::string rows(uint32_t width, uint32_t height, std::span<uint32_t> out, RawColour& raw) const;

private:
    std::string rgbaRows(uint32_t width, uint32_t height, std::span<uint32_t> out) const;
    std::string mosaicRows(uint32_t width, uint32_t height, std::span<uint32_t> out) const;
};

} // namespace fathom
