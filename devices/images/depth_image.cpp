// SPDX-License-Identifier: Apache-2.0
#include "devices/images/depth_image.h"

#include "devices/images/exr_image.h"
#include "devices/images/npy_image.h"
#include "devices/images/pgm_image.h"
#include "devices/images/tiff_image.h"
#include "engine/types/number_text.h"
#include "engine/types/read_file.h"
#include "engine/types/stand_in.h"

#include <algorithm>
#include <fstream>
#include <vector>

namespace fathom {

namespace {

constexpr size_t kMaxDepthFile = 256u << 20; // [bytes]; float64 of 3840x2160 is 64 MiB

// Why no reader knows the file.
std::string unknown(const std::filesystem::path& file) {
    const std::string other = standInOf(file);
    return !std::ifstream(isRegularFile(file) ? file : "") ? whyUnreadable(file)
           : other.empty()                                 ? "not PNG, PGM (P5), TIFF, NPY or EXR"
                                                           : other;
}

struct DepthFormat {
    bool (*is)(ImageBytes);
    DepthHeader (*head)(ImageBytes);
    std::string (*units)(ImageBytes, std::span<uint16_t>); // null: floating point only
    std::string (*metres)(ImageBytes, std::span<float>);   // null: 16 bits only
};

constexpr std::array kDepthFormats{
    DepthFormat{isPgm, pgmHeader, readPgm, nullptr}, DepthFormat{isTiff, tiffHeader, readTiff, readTiff},
    DepthFormat{isNpy, npyHeader, readNpy, readNpy}, DepthFormat{isExr, exrHeader, nullptr, readExr}};

// By the first bytes; null for PNG and whatever is not known.
const DepthFormat* formatOf(ImageBytes bytes) {
    const auto found = std::ranges::find_if(kDepthFormats, [&](const auto& f) { return f.is(bytes); });
    return found == kDepthFormats.end() ? nullptr : &*found;
}

ImageBytes asBytes(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

const DepthFormat* formatOf(const std::filesystem::path& file) {
    return formatOf(asBytes(firstBytes(file, 16)));
}

// The image's bytes when its header is as wanted, else the fault.
std::string checkedBytes(const std::filesystem::path& file, const DepthFormat& format, PngSize size,
                         bool metres, std::string& bytes) {
    auto text = readFileAtMost(file, kMaxDepthFile);
    if (!text || text->size() > kMaxDepthFile) {
        return text ? "over 256 MiB" : whyUnreadable(file);
    }
    bytes = std::move(*text);
    const DepthHeader head = format.head(asBytes(bytes));
    if (!head.fault.empty()) {
        return head.fault;
    }
    if (head.size != size) {
        return sizeText(head.size.width, head.size.height) + " pixels, not " +
               sizeText(size.width, size.height);
    }
    return head.metres == metres ? ""
           : metres              ? "16-bit values, not metres as in the first depth image"
                                 : "floating point, not 16-bit values as in the first depth image";
}

} // namespace

bool endsAs(const std::filesystem::path& file, std::span<const std::string_view> endings) {
    const bool hidden = file.filename().string().starts_with('.');
    return !hidden && std::ranges::find(endings, endingOf(file)) != endings.end();
}

DepthHeader depthImageHeader(const std::filesystem::path& file) {
    const DepthFormat* format = formatOf(file);
    if (format == nullptr) {
        const auto size = readPngSize(file);
        return size ? DepthHeader{*size, false, ""} : DepthHeader{{}, false, unknown(file)};
    }
    const auto text = readFileAtMost(file, kMaxDepthFile);
    return text && text->size() <= kMaxDepthFile ? format->head(asBytes(*text))
                                                 : DepthHeader{{}, false, "over 256 MiB"};
}

std::string readDepthImage(const std::filesystem::path& file, PngSize size, const DepthUnits& units,
                           std::span<uint16_t> out, uint64_t& beyond) {
    const DepthFormat* format = formatOf(file);
    if (format == nullptr) {
        return !readPngSize(file) ? unknown(file)
               : units.metres     ? "16-bit values, not metres as in the first depth image"
                                  : readDepthPng(file, size, out);
    }
    std::string bytes;
    const std::string fault = checkedBytes(file, *format, size, units.metres, bytes);
    if (!fault.empty()) {
        return fault;
    }
    if (!units.metres) {
        const bool swapped = units.swapped && format->units == readPgm;
        return swapped ? readSwappedPgm(asBytes(bytes), out) : format->units(asBytes(bytes), out);
    }
    std::vector<float> values(out.size());
    std::string damaged = format->metres(asBytes(bytes), values);
    std::transform(values.begin(), values.end(), out.begin(),
                   [&](float v) { return unitsOf(double{v}, units.valuesPerUnit, beyond); });
    return damaged;
}

ByteOrder depthImageOrder(const std::filesystem::path& file) {
    if (!isPgm(asBytes(firstBytes(file, 16)))) {
        return ByteOrder::Unknown;
    }
    const auto text = readFileAtMost(file, kMaxDepthFile);
    return text && text->size() <= kMaxDepthFile ? pgmOrder(asBytes(*text)) : ByteOrder::Unknown;
}

ValueSpan valueSpan(const std::filesystem::path& file, PngSize size) {
    const DepthFormat* format = formatOf(file);
    std::string bytes;
    ValueSpan span;
    if (format == nullptr || !checkedBytes(file, *format, size, true, bytes).empty()) {
        return span;
    }
    std::vector<float> values(size_t{size.width} * size.height);
    if (format->metres(asBytes(bytes), values).empty()) {
        for (const float value : values) {
            span.add(double{value});
        }
    }
    return span;
}

} // namespace fathom
