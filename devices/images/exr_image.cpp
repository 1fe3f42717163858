// SPDX-License-Identifier: Apache-2.0
#include "devices/images/exr_image.h"

#include "devices/bag/byte_cursor.h"
#include "devices/images/exr_header.h"
#include "devices/images/half_value.h"

#include <algorithm>
#include <array>
#include <vector>
#include <zlib.h>

namespace fathom {

namespace {

// ZIP stores differences of bytes, the even bytes before the odd ones.
bool unpackExr(ImageBytes packed, std::vector<uint8_t>& scratch, std::span<uint8_t> out) {
    uLongf size = out.size();
    scratch.resize(out.size());
    if (::uncompress(scratch.data(), &size, packed.data(), packed.size()) != Z_OK || size != out.size()) {
        return false;
    }
    for (size_t i = 1; i < size; ++i) {
        scratch[i] = static_cast<uint8_t>(scratch[i - 1] + scratch[i] - 128);
    }
    const size_t even = (size + 1) / 2;
    for (size_t i = 0; i < size; ++i) {
        out[i] = scratch[i / 2 + (i % 2 == 0 ? 0 : even)];
    }
    return true;
}

// Programs that write depth to R leave G and B at 0 or copy it there. An image of colours is no depth.
void checkEqual(const ExrHeader& head, std::span<const uint8_t> row) {
    const size_t size = head.width * (head.half ? sizeof(uint16_t) : sizeof(float));
    const std::span<const uint8_t> depth = row.subspan(head.channelAt, size);
    for (const size_t at : head.equalAt) {
        const std::span<const uint8_t> other = row.subspan(at, size);
        if (!std::ranges::equal(other, depth) &&
            std::ranges::any_of(other, [](uint8_t b) { return b != 0; })) {
            throw Error("EXR: channels: R, G and B with different values, a colour image (allowed: depth)");
        }
    }
}

// The rows of one chunk, to `out` from its first row on.
void takeRows(const ExrHeader& head, std::span<const uint8_t> rows, std::span<float> out) {
    for (size_t row = 0; row * head.rowBytes < rows.size(); ++row) {
        checkEqual(head, rows.subspan(row * head.rowBytes, head.rowBytes));
        const uint8_t* from = rows.data() + row * head.rowBytes + head.channelAt;
        for (uint32_t x = 0; x < head.width; ++x) {
            uint16_t half = 0;
            float& value = out[row * head.width + x];
            if (head.half) {
                std::memcpy(&half, from + size_t{2} * x, sizeof half);
                value = halfValue(half);
            } else {
                std::memcpy(&value, from + size_t{4} * x, sizeof value);
            }
        }
    }
}

void readChunks(ImageBytes bytes, const ExrHeader& head, std::span<float> out) {
    std::vector<uint8_t> scratch, unpacked;
    for (size_t i = 0; i < head.chunks.size(); ++i) {
        if (head.chunks[i] > bytes.size()) {
            throw Error("truncated");
        }
        ByteCursor cursor(bytes.subspan(head.chunks[i]));
        const auto begin = static_cast<uint32_t>(i) * head.rowsPerChunk,
                   count = std::min(head.rowsPerChunk, head.height - begin);
        if (int64_t{cursor.value<int32_t>()} != int64_t{head.firstRow} + begin) {
            throw Error("EXR: rows are not where the header says");
        }
        const ImageBytes stored = cursor.block();
        ImageBytes rows = stored;
        const size_t size = count * head.rowBytes;
        if (head.packed && stored.size() < size) { // stored as it is where zlib does not help
            unpacked.resize(size);
            rows = unpacked;
            if (!unpackExr(stored, scratch, unpacked)) {
                throw Error("EXR: damaged rows");
            }
        }
        if (rows.size() != size) {
            throw Error("EXR: rows of another size");
        }
        takeRows(head, rows, out.subspan(size_t{begin} * head.width));
    }
}

} // namespace

bool isExr(ImageBytes bytes) {
    constexpr std::array<uint8_t, 4> kMagic{0x76, 0x2f, 0x31, 0x01};
    return bytes.size() > kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

DepthHeader exrHeader(ImageBytes bytes) {
    const ExrHeader head = parseExrHeader(bytes);
    return {{head.width, head.height}, true, head.fault};
}

std::string readExr(ImageBytes bytes, std::span<float> out) {
    const ExrHeader head = parseExrHeader(bytes);
    if (!head.fault.empty()) {
        return head.fault;
    }
    if (size_t{head.width} * head.height != out.size()) {
        return "EXR: another size";
    }
    try {
        readChunks(bytes, head, out);
    } catch (const Error& e) {
        return e.what() == std::string_view("truncated") ? "EXR: truncated" : e.what();
    }
    return "";
}

} // namespace fathom
