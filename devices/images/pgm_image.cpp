// SPDX-License-Identifier: Apache-2.0
#include "devices/images/pgm_image.h"

#include <cctype>
#include <optional>
#include <vector>

namespace fathom {

namespace {

struct PgmHeader {
    uint32_t width = 0, height = 0, most = 0;
    size_t pixels = 0; // where they begin
};

// The next number, after white space and comments to the end of their line. At most six digits.
std::optional<uint32_t> pgmNumber(ImageBytes bytes, size_t& at) {
    bool comment = false;
    for (; at < bytes.size() && (comment || bytes[at] == '#' || std::isspace(bytes[at]) != 0); ++at) {
        comment = bytes[at] == '#' || (comment && bytes[at] != '\n' && bytes[at] != '\r');
    }
    uint32_t value = 0;
    const size_t begin = at;
    for (; at < bytes.size() && at < begin + 6 && std::isdigit(bytes[at]) != 0; ++at) {
        value = 10 * value + (bytes[at] - uint32_t{'0'});
    }
    return at == begin ? std::nullopt : std::optional(value);
}

std::optional<PgmHeader> parsePgm(ImageBytes bytes) {
    size_t at = 2; // "P5"
    const auto width = pgmNumber(bytes, at), height = pgmNumber(bytes, at), most = pgmNumber(bytes, at);
    if (!width || !height || !most || at >= bytes.size() || std::isspace(bytes[at]) == 0) {
        return std::nullopt;
    }
    return PgmHeader{*width, *height, *most, at + 1};
}

// As the format orders their bytes, whatever the maximum is. Returns the fault.
std::string readValues(ImageBytes bytes, const PgmHeader& head, std::span<uint16_t> out) {
    ImageBytes pixels = bytes.subspan(head.pixels);
    if (pixels.size() == 2 * out.size() + 1 &&
        pixels.back() == '\n') { // as text editors and some writers end it
        pixels = pixels.first(2 * out.size());
    }
    if (pixels.size() != 2 * out.size()) {
        return "PGM: " + std::to_string(pixels.size()) + " bytes of pixels, not " +
               std::to_string(2 * out.size());
    }
    for (size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<uint16_t>(pixels[2 * i] << 8 | pixels[2 * i + 1]);
    }
    return "";
}

std::string readOrdered(ImageBytes bytes, std::span<uint16_t> out, bool swapped) {
    const auto head = parsePgm(bytes);
    if (!head || size_t{head->width} * head->height != out.size()) {
        return "PGM: another size";
    }
    if (std::string fault = readValues(bytes, *head, out); !fault.empty()) {
        return fault;
    }
    for (uint16_t& value : out) {
        value = swapped ? __builtin_bswap16(value) : value;
        if (value > head->most) {
            return "PGM: value " + std::to_string(value) + " over its maximum " + std::to_string(head->most);
        }
    }
    return "";
}

} // namespace

bool isPgm(ImageBytes bytes) {
    return bytes.size() > 2 && bytes[0] == 'P' && bytes[1] == '5' && std::isspace(bytes[2]) != 0;
}

DepthHeader pgmHeader(ImageBytes bytes) {
    const auto head = parsePgm(bytes);
    DepthHeader out;
    if (!head) {
        out.fault = "PGM: a header that is not 'P5 WIDTH HEIGHT MAXIMUM'";
    } else if (head->most < 256 || head->most > 65535) {
        out.fault = "PGM: maximum value " + std::to_string(head->most) + " (allowed: 256 to 65535, 16 bits)";
    } else {
        out.size = {head->width, head->height};
    }
    return out;
}

std::string readPgm(ImageBytes bytes, std::span<uint16_t> out) {
    return readOrdered(bytes, out, false);
}

std::string readSwappedPgm(ImageBytes bytes, std::span<uint16_t> out) {
    return readOrdered(bytes, out, true);
}

ByteOrder pgmOrder(ImageBytes bytes) {
    const auto head = parsePgm(bytes);
    if (!head || head->most < 256 || bytes.size() / 2 < uint64_t{head->width} * head->height) {
        return ByteOrder::Unknown;
    }
    std::vector<uint16_t> values(size_t{head->width} * head->height);
    return readValues(bytes, *head, values).empty() ? orderOfUnits(values, head->width) : ByteOrder::Unknown;
}

} // namespace fathom
