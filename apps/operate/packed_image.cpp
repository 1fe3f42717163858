// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/packed_image.h"

namespace fathom::operate {

namespace {

constexpr size_t kMaxPackedPixels = 128; // of a run, or of a piece that has none

// Number of equal pixels from here on.
size_t runAt(std::span<const uint32_t> colour, size_t i) {
    size_t n = 1;
    while (n < kMaxPackedPixels && i + n < colour.size() && ((colour[i + n] ^ colour[i]) & 0xffffffu) == 0) {
        ++n;
    }
    return n;
}

void putPixel(std::vector<uint8_t>& out, uint32_t rgb) {
    out.insert(out.end(),
               {static_cast<uint8_t>(rgb), static_cast<uint8_t>(rgb >> 8), static_cast<uint8_t>(rgb >> 16)});
}

uint32_t pixelAt(std::span<const uint8_t> packed, size_t at) {
    return 0xff000000u | uint32_t{packed[at + 2]} << 16 | uint32_t{packed[at + 1]} << 8 | packed[at];
}

} // namespace

std::vector<uint8_t> packDepth(std::span<const uint16_t> depth) {
    std::vector<uint8_t> out;
    out.reserve(depth.size() + depth.size() / 4);
    uint16_t before = 0;
    for (const uint16_t value : depth) {
        const auto step = static_cast<int16_t>(value - before); // wraps around
        before = value;
        auto folded = static_cast<uint32_t>((step << 1 ^ step >> 15) & 0xffff); // 0, -1, 1, -2, ... in order
        for (; folded >= 128; folded >>= 7) {
            out.push_back(static_cast<uint8_t>(folded | 128u));
        }
        out.push_back(static_cast<uint8_t>(folded));
    }
    out.shrink_to_fit();
    return out;
}

std::vector<uint16_t> unpackDepth(std::span<const uint8_t> packed, size_t count) {
    std::vector<uint16_t> depth(count);
    size_t at = 0;
    uint16_t value = 0;
    for (uint16_t& out : depth) {
        uint32_t folded = 0;
        for (uint32_t shift = 0;; shift += 7) {
            const uint8_t byte = packed[at++];
            folded |= (byte & 127u) << shift;
            if (byte < 128) {
                break;
            }
        }
        const auto step = static_cast<int32_t>(folded >> 1) ^ -static_cast<int32_t>(folded & 1);
        out = value = static_cast<uint16_t>(value + step);
    }
    return depth;
}

// A byte below 128: that many pixels and one more follow. Otherwise: the next pixel counts that many times,
// less 127.
std::vector<uint8_t> packColour(std::span<const uint32_t> colour) {
    std::vector<uint8_t> out;
    out.reserve(colour.size() * 3 + colour.size() / kMaxPackedPixels + 1);
    for (size_t i = 0; i < colour.size();) {
        if (const size_t run = runAt(colour, i); run > 1) {
            out.push_back(static_cast<uint8_t>(run + 127));
            putPixel(out, colour[i]);
            i += run;
            continue;
        }
        const size_t head = out.size();
        out.push_back(0);
        size_t n = 0;
        for (; n < kMaxPackedPixels && i < colour.size() && (n == 0 || runAt(colour, i) == 1); ++n) {
            putPixel(out, colour[i++]);
        }
        out[head] = static_cast<uint8_t>(n - 1);
    }
    out.shrink_to_fit();
    return out;
}

std::vector<uint32_t> unpackColour(std::span<const uint8_t> packed, size_t count) {
    std::vector<uint32_t> colour;
    colour.reserve(count);
    for (size_t at = 0; at < packed.size() && colour.size() < count;) {
        const uint8_t head = packed[at++];
        if (head >= 128) {
            colour.insert(colour.end(), head - 127u, pixelAt(packed, at));
            at += 3;
            continue;
        }
        for (uint32_t n = 0; n <= head; ++n, at += 3) {
            colour.push_back(pixelAt(packed, at));
        }
    }
    return colour;
}

} // namespace fathom::operate
