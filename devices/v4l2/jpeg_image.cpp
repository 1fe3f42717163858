// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/jpeg_image.h"

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

} // namespace

bool isJpeg(std::span<const std::byte> bytes) {
    return bytes.size() > 2 && bytes[0] == std::byte{0xff} && bytes[1] == std::byte{0xd8};
}

std::optional<VideoSize> jpegSize(std::span<const std::byte> bytes) {
    int width = 0, height = 0, sampling = 0, space = 0;
    const Decoder decoder;
    if (!isJpeg(bytes) || decoder.get() == nullptr ||
        tjDecompressHeader3(decoder.get(), reinterpret_cast<const unsigned char*>(bytes.data()),
                            static_cast<unsigned long>(bytes.size()), &width, &height, &sampling,
                            &space) != 0) {
        return std::nullopt;
    }
    return VideoSize{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

std::string readJpeg(std::span<const std::byte> bytes, VideoSize size, std::span<uint32_t> out) {
    thread_local const Decoder kDecoder;
    if (kDecoder.get() == nullptr) {
        return std::string("JPEG: ") + tjGetErrorStr();
    }
    const auto* in = reinterpret_cast<const unsigned char*>(bytes.data());
    const auto count = static_cast<unsigned long>(bytes.size());
    int width = 0, height = 0, sampling = 0, space = 0;
    if (tjDecompressHeader3(kDecoder.get(), in, count, &width, &height, &sampling, &space) != 0) {
        return std::string("JPEG: ") + tjGetErrorStr2(kDecoder.get());
    }
    const VideoSize got{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    if (got != size) {
        return "JPEG of " + sizeName(got) + ", " + sizeName(size) + " was agreed";
    }
    if (tjDecompress2(kDecoder.get(), in, count, reinterpret_cast<unsigned char*>(out.data()), width, 0,
                      height, TJPF_RGBA, TJFLAG_STOPONWARNING) != 0) {
        return std::string("JPEG: ") + tjGetErrorStr2(kDecoder.get());
    }
    return "";
}

} // namespace fathom
