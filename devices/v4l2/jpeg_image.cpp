// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/jpeg_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <turbojpeg.h>

namespace fathom {

namespace {

// One decoder per thread, because its set-up costs more than decoding a small image.
class Decoder {
public:
    Decoder()
        : handle_(tjInitDecompress()) {}
    ~Decoder() {
        if (handle_ != nullptr) {
            tjDestroy(handle_);
        }
    }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    tjhandle get() const { return handle_; }

private:
    tjhandle handle_;
};

std::string faultOf(const Decoder& decoder) {
    return std::string("JPEG: ") + tjGetErrorStr2(decoder.get());
}

// A few bytes between the last sample and the end marker are padding, which many webcams send; more are the
// rest of a damaged image. The decoder reports only its first warning, and this one can only be the last.
bool endsPadded(const Decoder& decoder) {
    constexpr unsigned kMaxPadding = 16; // [bytes]
    unsigned extra = 0, marker = 0;
    return tjGetErrorCode(decoder.get()) == TJERR_WARNING &&
           std::sscanf(tjGetErrorStr2(decoder.get()),
                       "Corrupt JPEG data: %u extraneous bytes before marker %x", &extra, &marker) == 2 &&
           extra <= kMaxPadding && marker == 0xd9;
}

// Rows of each plane.
struct PlaneRows {
    std::array<unsigned char*, 3> planes;
    std::array<int, 3> steps; // [bytes]
};

// False for a warning, too: a damaged image is not decoded on.
bool decodePlanes(const Decoder& decoder, std::span<const std::byte> bytes, VideoSize size, PlaneRows rows) {
    const auto decode = [&](int flags) {
        return tjDecompressToYUVPlanes(decoder.get(), reinterpret_cast<const unsigned char*>(bytes.data()),
                                       static_cast<unsigned long>(bytes.size()), rows.planes.data(),
                                       static_cast<int>(size.width), rows.steps.data(),
                                       static_cast<int>(size.height), flags) == 0;
    };
    if (decode(TJFLAG_STOPONWARNING)) {
        return true;
    }
    return endsPadded(decoder) && (decode(0) || endsPadded(decoder));
}

uint32_t wholeWords(int bytes) {
    return (static_cast<uint32_t>(bytes) + 3) / 4 * 4;
}

// Of rows in whole words. The decoder writes whole blocks of samples, so planes may exceed the image.
ColourPlanes jpegPlanes(VideoSize size, int sampling) {
    const int width = static_cast<int>(size.width), height = static_cast<int>(size.height);
    ColourPlanes p;
    p.lumaStep = wholeWords(tjPlaneWidth(0, width, sampling));
    p.blue = p.red = p.lumaStep * static_cast<uint32_t>(tjPlaneHeight(0, height, sampling));
    if (sampling == TJSAMP_GRAY) { // one sample for all pixels
        p.across = p.down = 31;
        return p;
    }
    p.chromaStep = wholeWords(tjPlaneWidth(1, width, sampling));
    p.red += p.chromaStep * static_cast<uint32_t>(tjPlaneHeight(1, height, sampling));
    p.across = static_cast<uint32_t>(std::countr_zero(static_cast<uint32_t>(tjMCUWidth[sampling] / 8)));
    p.down = static_cast<uint32_t>(std::countr_zero(static_cast<uint32_t>(tjMCUHeight[sampling] / 8)));
    return p;
}

} // namespace

bool isJpeg(std::span<const std::byte> bytes) {
    return bytes.size() > 2 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{0xd8};
}

std::optional<JpegHeader> jpegHeader(std::span<const std::byte> bytes) {
    int width = 0, height = 0, sampling = 0, space = 0;
    const Decoder decoder;
    if (!isJpeg(bytes) || decoder.get() == nullptr ||
        tjDecompressHeader3(decoder.get(), reinterpret_cast<const unsigned char*>(bytes.data()),
                            static_cast<unsigned long>(bytes.size()), &width, &height, &sampling,
                            &space) != 0) {
        return std::nullopt;
    }
    return JpegHeader{{static_cast<uint32_t>(width), static_cast<uint32_t>(height)}, space == TJCS_GRAY};
}

std::string readJpeg(std::span<const std::byte> bytes, VideoSize size, std::span<std::byte> out,
                     RawColour& raw) {
    thread_local const Decoder kDecoder;
    if (kDecoder.get() == nullptr) {
        return std::string("JPEG: ") + tjGetErrorStr();
    }
    const auto* in = reinterpret_cast<const unsigned char*>(bytes.data());
    const auto count = static_cast<unsigned long>(bytes.size());
    int width = 0, height = 0, sampling = 0, space = 0;
    if (tjDecompressHeader3(kDecoder.get(), in, count, &width, &height, &sampling, &space) != 0) {
        return faultOf(kDecoder);
    }
    const VideoSize got{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    if (got != size) {
        return "JPEG of " + sizeName(got) + ", " + sizeName(size) + " was agreed";
    }
    if (space != TJCS_YCbCr && space != TJCS_GRAY) {
        return "JPEG: colour space " + std::to_string(space) + " (allowed: Y Cb Cr, grey)";
    }
    const ColourPlanes p = jpegPlanes(size, sampling);
    const size_t end = size_t{p.red} + (sampling == TJSAMP_GRAY ? 1 : p.red - p.blue);
    if (end > out.size()) {
        return "JPEG: sampling " + std::to_string(sampling) + " (allowed: at most 4:4:4)";
    }
    auto* luma = reinterpret_cast<unsigned char*>(out.data());
    luma[p.blue] = 128;
    const int chromaStep = static_cast<int>(p.chromaStep);
    const PlaneRows rows{{luma, luma + p.blue, luma + p.red},
                         {static_cast<int>(p.lumaStep), chromaStep, chromaStep}};
    if (!decodePlanes(kDecoder, bytes, size, rows)) {
        return faultOf(kDecoder);
    }
    raw = {ColourFormat::JpegPlanes, size.width, size.height, out.first(end), p};
    return "";
}

} // namespace fathom
