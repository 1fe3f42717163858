// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/colour_image.h"

#include "devices/v4l2/jpeg_image.h"
#include "engine/types/read_file.h"
#include "engine/types/stand_in.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace fathom {

namespace {

constexpr size_t kMaxJpeg = 64u << 20; // [bytes]

// Of a file that is no JPEG: why it is no image that is read; empty for a PNG and for one that cannot be
// opened.
std::string whyUnknown(const std::filesystem::path& file) {
    const auto text = readFileAtMost(file, kPngSignature.size() - 1);
    if (!text ||
        std::ranges::equal(*text, kPngSignature, {}, [](char c) { return static_cast<uint8_t>(c); })) {
        return "";
    }
    const std::string other = standInOf(file);
    return !other.empty() ? other : text->empty() ? "an empty file" : "not PNG or JPEG";
}

bool beginsAsJpeg(const std::filesystem::path& file) {
    std::array<char, 3> head{};
    return isRegularFile(file) && std::ifstream(file, std::ios::binary).read(head.data(), head.size()) &&
           isJpeg(std::as_bytes(std::span(head)));
}

} // namespace

std::optional<PngSize> colourImageSize(const std::filesystem::path& file) {
    if (!beginsAsJpeg(file)) {
        return readPngSize(file);
    }
    const auto text = readFileAtMost(file, kMaxJpeg);
    const auto head = text ? jpegHeader(std::as_bytes(std::span(*text))) : std::nullopt;
    return head ? std::optional(PngSize{head->size.width, head->size.height}) : std::nullopt;
}

ColourFormat colourImageFormat(const std::filesystem::path& file) {
    return beginsAsJpeg(file) ? ColourFormat::JpegPlanes : ColourFormat::Rgba;
}

std::string readColourImage(const std::filesystem::path& file, PngSize size, std::span<uint32_t> target,
                            RawColour& raw) {
    if (!beginsAsJpeg(file)) {
        const std::string unknown = whyUnknown(file);
        return unknown.empty() ? readColourPng(file, size, target) : unknown;
    }
    const auto text = readFileAtMost(file, kMaxJpeg);
    return text ? readJpeg(std::as_bytes(std::span(*text)), {size.width, size.height},
                           std::as_writable_bytes(target), raw)
                : "a JPEG of over 64 MiB";
}

} // namespace fathom
