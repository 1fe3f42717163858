// SPDX-License-Identifier: Apache-2.0
// PNG images of a recording, decoded by libpng straight into the camera's memory.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace fathom {

// Size of an image.
struct PngSize {
    uint32_t width = 0, height = 0; // [pixels]
    bool operator==(const PngSize&) const = default;
};

// Width and height from the file header; empty when it is not a readable PNG.
std::optional<PngSize> readPngSize(const std::filesystem::path& file);

// Both return the fault, or empty when the file was read completely; after a fault the target is undefined.
// target has size.width x size.height elements; another size or pixel type is rejected before decoding.
std::string readDepthPng(const std::filesystem::path& file, PngSize size,
                         std::span<uint16_t> target); // 16-bit grey
std::string readDepthPng(std::span<const uint8_t> bytes, PngSize size, std::span<uint16_t> target);
// RGB, RGBA, grey (with or without alpha) of 8 or 16 bits, or palette -> R8 G8 B8 A8 (0xAABBGGRR); alpha 255
// when the file has none.
std::string readColourPng(const std::filesystem::path& file, PngSize size, std::span<uint32_t> target);
std::string readColourPng(std::span<const uint8_t> bytes, PngSize size, std::span<uint32_t> target);

// The first bytes of every PNG.
inline constexpr std::array<uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

// What the first bytes of a PNG state; empty when they are not those of a PNG.
struct PngHeader {
    PngSize size;
    int bits = 0; // per channel
    bool grey = false;
};
std::optional<PngHeader> pngHeader(std::span<const uint8_t> bytes);

} // namespace fathom
