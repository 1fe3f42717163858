// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/matroska_images.h"

#include "devices/bag/byte_writer.h"

namespace fathom {

namespace {

constexpr uint64_t kMaxSide = 65535; // [pixels]

// Encodings by the code of a track. bytes: per pixel of a row; 0: compressed.
struct KnownCode {
    const char *fourcc, *encoding;
    uint32_t bytes;
    bool bigEndian;
};
constexpr std::array kCodes{KnownCode{"b16g", "mono16", 2, true}, KnownCode{"Y16 ", "mono16", 2, false},
                            KnownCode{"NV12", "nv12", 1, false},  KnownCode{"YUY2", "yuy2", 2, false},
                            KnownCode{"BGRA", "bgra8", 4, false}, KnownCode{"MJPG", "mjpg", 0, false}};

} // namespace

MatroskaImages::MatroskaImages(const MatroskaTrack& track, std::string called)
    : name(std::move(called)) {
    const auto code = std::ranges::find(kCodes, track.fourcc, &KnownCode::fourcc);
    const bool sized =
        track.width > 0 && track.width <= kMaxSide && track.height > 0 && track.height <= kMaxSide;
    if (code == kCodes.end() || !sized || track.encoded) {
        return;
    }
    // Early recordings call depth YUY2, in little-endian order.
    encoding = name != "COLOR" && track.fourcc == "YUY2" ? "mono16" : code->encoding;
    width = static_cast<uint32_t>(track.width);
    height = static_cast<uint32_t>(track.height);
    step = width * code->bytes;
    bigEndian = code->bigEndian;
}

std::vector<uint8_t> MatroskaImages::message(uint64_t time, std::span<const uint8_t> data) const {
    constexpr uint64_t kPerSecond = 1'000'000'000;
    if (encoding.empty()) {
        return {data.begin(), data.end()};
    }
    ByteWriter out;
    out.value(uint32_t{0}); // sequence number
    out.value(static_cast<uint32_t>(time / kPerSecond));
    out.value(static_cast<uint32_t>(time % kPerSecond));
    out.text(name); // as frame: tracks are of different lenses
    out.value(height);
    out.value(width);
    out.text(encoding);
    out.value(uint8_t{bigEndian});
    out.value(step);
    out.value(static_cast<uint32_t>(data.size()));
    out.append(data);
    return out.bytes();
}

} // namespace fathom
