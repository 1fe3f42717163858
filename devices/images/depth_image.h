// SPDX-License-Identifier: Apache-2.0
// Depth images of a recording folder, by their first bytes: PNG, PGM and TIFF of 16 bits; TIFF, NPY and EXR
// of floating point, in metres; NPY of 16 bits.
#pragma once

#include "devices/images/byte_order.h"
#include "devices/images/depth_header.h"
#include "devices/images/metre_units.h"

#include <array>
#include <filesystem>
#include <string_view>

namespace fathom {

// Endings of their names, in lower case.
inline constexpr std::array<std::string_view, 6> kDepthEndings{".png",  ".pgm", ".tif",
                                                               ".tiff", ".npy", ".exr"};
inline constexpr std::array<std::string_view, 3> kColourEndings{".png", ".jpg", ".jpeg"};
// Whether the name ends in one of them, in upper or lower case. Not of hidden files: archives of macOS hold a
// "._0.png" next to each "0.png".
bool endsAs(const std::filesystem::path& file, std::span<const std::string_view> endings);

// How values become those of a frame.
struct DepthUnits {
    bool metres = false;        // images of floating point are expected, else of 16 bits
    double valuesPerUnit = 1.0; // of floating point: value of the frame's depth 1
    bool swapped = false;       // of PGM: the least significant byte is first
};

// Reads the file, at most 256 MiB.
DepthHeader depthImageHeader(const std::filesystem::path& file);
// Raw values, 0 = no measurement; NaN and infinity become 0, and so does what is too far for 16 bits, counted
// in `beyond`. Returns the fault, or empty when everything was read; another size or kind than asked for is a
// fault.
std::string readDepthImage(const std::filesystem::path& file, PngSize size, const DepthUnits& units,
                           std::span<uint16_t> out, uint64_t& beyond);
// Whether the bytes of a PGM have the order of that format; Unknown for others, whose order is stated.
ByteOrder depthImageOrder(const std::filesystem::path& file);
// The values of a floating-point image of this size; without any when it cannot be read.
ValueSpan valueSpan(const std::filesystem::path& file, PngSize size);

} // namespace fathom
