// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/compressed_depth.h"

#include "devices/recorded/png_image.h"

#include <cmath>
#include <cstring>

namespace fathom {

namespace {

constexpr size_t kDepthHeader = 12, kRvlHeader = 8; // [bytes]: kind and two floats; then columns and rows

// Numbers of 3 bits per nibble, least significant group first; the fourth bit says that more follow. Nibbles
// are taken from words of 32 bits, most significant first.
class Nibbles {
public:
    explicit Nibbles(std::span<const uint8_t> bytes)
        : bytes_(bytes) {}

    bool number(uint32_t& out) {
        out = 0;
        for (uint32_t shift = 0; shift < 32; shift += 3) {
            if (left_ == 0 && !load()) {
                return false;
            }
            const uint32_t nibble = word_ >> 28;
            word_ <<= 4;
            --left_;
            out |= (nibble & 7) << shift;
            if ((nibble & 8) == 0) {
                return true;
            }
        }
        return false;
    }

private:
    bool load() {
        if (bytes_.empty()) {
            return false;
        }
        const size_t count = std::min<size_t>(4, bytes_.size());
        word_ = 0;
        std::memcpy(&word_, bytes_.data(), count); // the last word may be cut
        bytes_ = bytes_.subspan(count);
        left_ = 8;
        return true;
    }

    std::span<const uint8_t> bytes_;
    uint32_t word_ = 0, left_ = 0;
};

} // namespace

bool unpackRvl(std::span<const uint8_t> in, std::span<uint16_t> out) {
    Nibbles nibbles(in);
    uint32_t previous = 0;
    for (size_t at = 0; at < out.size();) {
        uint32_t zeros = 0, values = 0;
        if (!nibbles.number(zeros) || !nibbles.number(values) || zeros + uint64_t{values} > out.size() - at ||
            zeros + values == 0) {
            return false;
        }
        for (const size_t end = at + zeros; at < end; ++at) {
            out[at] = 0;
        }
        for (const size_t end = at + values; at < end; ++at) {
            uint32_t step = 0;
            if (!nibbles.number(step)) {
                return false;
            }
            previous += (step >> 1) ^ (0u - (step & 1)); // zigzag: 0, -1, 1, -2, ...
            out[at] = static_cast<uint16_t>(previous);
        }
    }
    return true;
}

bool CompressedDepth::holdsPng() const {
    return data.size() > kDepthHeader && pngHeader(data.subspan(kDepthHeader)).has_value();
}

std::array<float, 2> CompressedDepth::quantum() const {
    std::array<float, 2> quantum{};
    if ((rvl && data.size() >= kDepthHeader) || holdsPng()) {
        std::memcpy(quantum.data(), data.data() + 4, sizeof quantum);
    }
    return quantum;
}

// q (q + 1) and 1 - q (q + 1) / farthest, with a quantum q of 1 and more.
bool CompressedDepth::quantised() const {
    const auto [factor, offset] = quantum();
    return factor >= 1.0f && factor < 1e9f && offset < 1.0f && offset > -1e9f && offset != 0.0f;
}

std::span<const uint8_t> CompressedDepth::png() const {
    return holdsPng() ? data.subspan(kDepthHeader) : data;
}

std::optional<std::pair<uint32_t, uint32_t>> CompressedDepth::size() const {
    if (data.size() < kDepthHeader + kRvlHeader) {
        return std::nullopt;
    }
    if (!rvl) {
        const auto header = pngHeader(png());
        return header ? std::optional(std::pair(header->size.width, header->size.height)) : std::nullopt;
    }
    uint32_t words[2];
    std::memcpy(words, data.data() + kDepthHeader, sizeof words);
    return std::pair(words[0], words[1]);
}

std::string CompressedDepth::values(uint32_t width, uint32_t height, std::span<uint16_t> out) const {
    if (size() != std::pair(width, height)) {
        return "a compressed depth image of another size, or without a header";
    }
    if (!rvl) {
        return readDepthPng(png(), {width, height}, out);
    }
    return unpackRvl(data.subspan(kDepthHeader + kRvlHeader), out.first(size_t{width} * height))
               ? ""
               : "RVL: damaged";
}

double CompressedDepth::metres(uint16_t stored) const {
    const auto [factor, offset] = quantum();
    const double inverse = static_cast<double>(stored) - double{offset};
    const bool sound = inverse > 0.0 && factor > 0.0f && std::isfinite(factor);
    return stored == 0 || !sound ? 0.0 : double{factor} / inverse;
}

} // namespace fathom
