// SPDX-License-Identifier: Apache-2.0
#include "devices/images/tiff_image.h"

#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <tiffio.h>
#include <vector>

namespace fathom {

namespace {

constexpr tmsize_t kMaxTiffBlock = tmsize_t{128} << 20; // [bytes] that libtiff may allocate at once
constexpr std::array<uint16_t, 5> kTiffPacked{COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS,
                                              COMPRESSION_DEFLATE, COMPRESSION_ADOBE_DEFLATE};

// The file in memory, and the first error that libtiff reports.
struct TiffStream {
    ImageBytes bytes;
    size_t at = 0;
    std::array<char, 160> error{};
};

tmsize_t readStream(thandle_t handle, void* to, tmsize_t size) {
    auto& stream = *static_cast<TiffStream*>(handle);
    const size_t left = stream.bytes.size() - std::min(stream.at, stream.bytes.size());
    const size_t count = std::min(left, static_cast<size_t>(std::max<tmsize_t>(0, size)));
    if (count > 0) {
        std::memcpy(to, stream.bytes.data() + stream.at, count);
    }
    stream.at += count;
    return static_cast<tmsize_t>(count);
}

toff_t seekStream(thandle_t handle, toff_t to, int whence) {
    auto& stream = *static_cast<TiffStream*>(handle);
    const toff_t from = whence == SEEK_SET ? 0 : (whence == SEEK_CUR ? stream.at : stream.bytes.size());
    stream.at = static_cast<size_t>(from + to);
    return from + to;
}

toff_t sizeStream(thandle_t handle) {
    return static_cast<TiffStream*>(handle)->bytes.size();
}

tmsize_t writeNothing(thandle_t, void*, tmsize_t) {
    return 0;
}

int closeStream(thandle_t) {
    return 0;
}

int keepTiffError(TIFF*, void* user, const char*, const char* format, va_list arguments) {
    auto& error = static_cast<TiffStream*>(user)->error;
    if (error[0] == '\0') {
        std::vsnprintf(error.data(), error.size(), format, arguments);
    }
    return 1; // no other handler
}

int ignoreTiffWarning(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

struct CloseTiff {
    void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
};
using OpenTiff = std::unique_ptr<TIFF, CloseTiff>;

OpenTiff openTiff(TiffStream& stream) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    if (options == nullptr) {
        return nullptr;
    }
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, kMaxTiffBlock);
    TIFFOpenOptionsSetErrorHandlerExtR(options, keepTiffError, &stream);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignoreTiffWarning, &stream);
    OpenTiff tiff(TIFFClientOpenExt("image", "rm", &stream, readStream, writeNothing, seekStream, closeStream,
                                    sizeStream, nullptr, nullptr, options)); // m: no mapping
    TIFFOpenOptionsFree(options);
    return tiff;
}

uint16_t tiffField(TIFF* tiff, uint32_t tag, uint16_t fallback) {
    uint16_t value = fallback;
    return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : fallback;
}

std::string tiffFault(const char* field, uint32_t value, const char* allowed) {
    return std::string("TIFF: ") + field + ": " + std::to_string(value) + " (allowed: " + allowed + ")";
}

DepthHeader headOf(TIFF* tiff) {
    DepthHeader head;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &head.size.width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &head.size.height);
    const uint16_t bits = tiffField(tiff, TIFFTAG_BITSPERSAMPLE, 1),
                   format = tiffField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT),
                   channels = tiffField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1),
                   packed = tiffField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE),
                   shade = tiffField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK),
                   turn = tiffField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    head.metres = format == SAMPLEFORMAT_IEEEFP;
    const bool values = head.metres ? bits == 32 || bits == 64 : format == SAMPLEFORMAT_UINT && bits == 16;
    if (head.size.width < 1 || head.size.height < 1 || head.size.width > kMaxImageWidth ||
        head.size.height > kMaxImageHeight) {
        head.fault =
            "TIFF: " + sizeText(head.size.width, head.size.height) + " pixels (allowed: at most 3840x2160)";
    } else if (channels != 1) {
        head.fault = tiffFault("SamplesPerPixel", channels, "1");
    } else if (!values) {
        head.fault = "TIFF: " + std::to_string(bits) + " bits of sample format " + std::to_string(format) +
                     " (allowed: 16 bits without sign, 32 or 64 of floating point)";
    } else if (shade != PHOTOMETRIC_MINISBLACK) {
        head.fault = tiffFault("PhotometricInterpretation", shade, "1, zero is black");
    } else if (turn != ORIENTATION_TOPLEFT) {
        head.fault = tiffFault("Orientation", turn, "1, rows from the top");
    } else if (TIFFIsTiled(tiff) != 0) {
        head.fault = "TIFF: tiles (allowed: strips)";
    } else if (std::find(kTiffPacked.begin(), kTiffPacked.end(), packed) == kTiffPacked.end()) {
        head.fault = tiffFault("Compression", packed, "none, LZW, PackBits, Deflate");
    }
    return head;
}

std::string libtiff(const TiffStream& stream, const char* otherwise) {
    return std::string("libtiff: ") + (stream.error[0] != '\0' ? stream.error.data() : otherwise);
}

template <class Stored, class Value>
bool readRows(TIFF* tiff, uint32_t width, std::span<Value> out) {
    const size_t rowBytes = width * sizeof(Stored);
    if (TIFFScanlineSize64(tiff) != rowBytes) {
        return false;
    }
    std::vector<Stored> row(width);
    for (uint32_t y = 0; y * size_t{width} < out.size(); ++y) {
        if (TIFFReadScanline(tiff, row.data(), y, 0) != 1) {
            return false;
        }
        std::transform(row.begin(), row.end(), out.begin() + static_cast<std::ptrdiff_t>(y * size_t{width}),
                       [](Stored value) { return static_cast<Value>(value); });
    }
    return true;
}

template <class Value, class Read>
std::string tiffValues(ImageBytes bytes, bool metres, std::span<Value> out, const Read& read) {
    TiffStream stream{bytes, 0, {}};
    const OpenTiff tiff = openTiff(stream);
    if (!tiff) {
        return libtiff(stream, "not a TIFF");
    }
    const DepthHeader head = headOf(tiff.get());
    if (!head.fault.empty()) {
        return head.fault;
    }
    if (head.metres != metres || size_t{head.size.width} * head.size.height != out.size()) {
        return "TIFF: another size or kind";
    }
    return read(tiff.get(), head.size.width) ? "" : libtiff(stream, "rows that cannot be read");
}

} // namespace

bool isTiff(ImageBytes bytes) {
    constexpr std::array<std::array<uint8_t, 4>, 4> kMagic{
        {{'I', 'I', 42, 0}, {'M', 'M', 0, 42}, {'I', 'I', 43, 0}, {'M', 'M', 0, 43}}};
    return std::any_of(kMagic.begin(), kMagic.end(), [&](const auto& magic) {
        return bytes.size() > magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
    });
}

DepthHeader tiffHeader(ImageBytes bytes) {
    TiffStream stream{bytes, 0, {}};
    const OpenTiff tiff = openTiff(stream);
    return tiff ? headOf(tiff.get()) : DepthHeader{{}, false, libtiff(stream, "not a TIFF")};
}

std::string readTiff(ImageBytes bytes, std::span<uint16_t> out) {
    return tiffValues(bytes, false, out,
                      [&](TIFF* tiff, uint32_t width) { return readRows<uint16_t>(tiff, width, out); });
}

std::string readTiff(ImageBytes bytes, std::span<float> out) {
    return tiffValues(bytes, true, out, [&](TIFF* tiff, uint32_t width) {
        return tiffField(tiff, TIFFTAG_BITSPERSAMPLE, 32) == 32 ? readRows<float>(tiff, width, out)
                                                                : readRows<double>(tiff, width, out);
    });
}

} // namespace fathom
