// SPDX-License-Identifier: Apache-2.0
// Depth images as compressed_depth_image_transport publishes them: PNG or RVL after a header of 12 bytes.
// Some bridges send the PNG without that header.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace fathom {

// RVL (A. D. Wilson, Fast Lossless Depth Image Compression, 2017) to out.size() values. False when the bytes
// end early or hold another number of values.
bool unpackRvl(std::span<const uint8_t> in, std::span<uint16_t> out);

// data: header and image. codec: the text after the encoding ("compressedDepth png", "compressedDepth rvl").
struct CompressedDepth {
    std::span<const uint8_t> data;
    bool rvl = false;

    // Whether a PNG follows the header.
    bool holdsPng() const;
    // Whether the header quantises inverse depth, as that of a 32FC1 image does. Headers of 16UC1 images hold
    // no numbers there.
    bool quantised() const;
    // Width and height; empty without a readable header.
    std::optional<std::pair<uint32_t, uint32_t>> size() const;
    // The values as stored: raw units of a 16UC1 image, inverse depth of a 32FC1 image. Returns the fault, or
    // empty.
    std::string values(uint32_t width, uint32_t height, std::span<uint16_t> out) const;
    // Metres of a stored value of a 32FC1 image; 0 = no measurement.
    double metres(uint16_t stored) const;

private:
    // stored = quantum[0] / metres + quantum[1]; zeros without the header.
    std::array<float, 2> quantum() const;
    // The bytes of the PNG, after the header or without one.
    std::span<const uint8_t> png() const;
};

} // namespace fathom
