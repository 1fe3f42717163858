// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/unpack_chunk.h"

#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <bzlib.h>
#include <lz4frame.h>
#include <memory>
#include <zstd.h>

namespace fathom {

namespace {

constexpr uint64_t kMaxLz4 = 255, kMaxOther = 65536; // largest compression ratios of the formats

struct FreeContext {
    void operator()(LZ4F_dctx* context) const noexcept { LZ4F_freeDecompressionContext(context); }
};

size_t unpackLz4(std::span<const uint8_t> packed, std::vector<uint8_t>& out) {
    LZ4F_dctx* made = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) {
        throw Error("lz4: no memory");
    }
    const std::unique_ptr<LZ4F_dctx, FreeContext> context(made);
    size_t from = 0, to = 0;
    while (from < packed.size() && to < out.size()) {
        size_t read = packed.size() - from, written = out.size() - to;
        const size_t left =
            LZ4F_decompress(context.get(), out.data() + to, &written, packed.data() + from, &read, nullptr);
        if (LZ4F_isError(left)) {
            throw Error(std::string("lz4: ") + LZ4F_getErrorName(left));
        }
        from += read;
        to += written;
        if (read == 0 && written == 0) {
            break;
        }
    }
    return to;
}

size_t unpackBz2(std::span<const uint8_t> packed, std::vector<uint8_t>& out) {
    auto size = static_cast<unsigned>(out.size());
    auto* from = const_cast<char*>(reinterpret_cast<const char*>(packed.data()));
    const int result = BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(out.data()), &size, from,
                                                  static_cast<unsigned>(packed.size()), 0, 0);
    if (result != BZ_OK) {
        throw Error("bz2: error " + std::to_string(result));
    }
    return size;
}

size_t unpackZstd(std::span<const uint8_t> packed, std::vector<uint8_t>& out) {
    const size_t got = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
    if (ZSTD_isError(got) != 0) {
        throw Error(std::string("zstd: ") + ZSTD_getErrorName(got));
    }
    return got;
}

} // namespace

std::vector<uint8_t> unpackChunk(const std::string& compression, std::span<const uint8_t> packed,
                                 uint32_t size) {
    if (compression == "none") {
        return {packed.begin(), packed.end()};
    }
    const uint64_t most = (packed.size() + 64) * (compression == "lz4" ? kMaxLz4 : kMaxOther);
    if (size > most) { // check before allocating
        throw Error("a chunk of " + std::to_string(packed.size()) + " bytes cannot hold the " +
                    std::to_string(size) + " that it declares");
    }
    std::vector<uint8_t> out(size);
    size_t got = 0;
    if (compression == "lz4") {
        got = unpackLz4(packed, out);
    } else if (compression == "bz2") {
        got = unpackBz2(packed, out);
    } else if (compression == "zstd") {
        got = unpackZstd(packed, out);
    } else {
        throw Error("compression '" + compression + "' is not known");
    }
    if (got != size) {
        throw Error(compression + ": " + std::to_string(got) + " bytes where " + std::to_string(size) +
                    " are declared");
    }
    return out;
}

// No message begins with these bytes: not one in CDR, and in ROS 1 the sequence number would be over 4e9.
MessageBytes unpackMessage(MessageBytes message) {
    constexpr std::array<uint8_t, 4> kZstdMagic{0x28, 0xb5, 0x2f, 0xfd};
    constexpr uint64_t kMaxUnpacked = 1 << 28; // [bytes]
    const std::span<const uint8_t> packed = message.view;
    if (packed.size() < kZstdMagic.size() ||
        !std::equal(kZstdMagic.begin(), kZstdMagic.end(), packed.begin())) {
        return message;
    }
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR || size > kMaxUnpacked) {
        throw Error("zstd: no size, or one over " + std::to_string(kMaxUnpacked) + " bytes");
    }
    return MessageBytes::of(unpackChunk("zstd", packed, static_cast<uint32_t>(size)));
}

} // namespace fathom
