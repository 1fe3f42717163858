// SPDX-License-Identifier: Apache-2.0
// Metadata of a frame as the kernel hands them over, without a camera.
#include "devices/v4l2/frame_metadata.h"

#include <doctest/doctest.h>
#include <vector>

using namespace fathom;

namespace {

void put(std::vector<uint8_t>& bytes, std::initializer_list<uint32_t> words) {
    for (const uint32_t word : words) {
        for (int i = 0; i < 4; ++i) {
            bytes.push_back(static_cast<uint8_t>(word >> (8 * i)));
        }
    }
}

// The driver's 10 bytes, a payload header with both stamps, a block of depth control, one of capture timing.
std::vector<uint8_t> record(uint32_t flags, uint32_t latency) {
    std::vector<uint8_t> bytes(10, 0xaa);
    bytes.push_back(12 + 60 + 40);
    bytes.push_back(0x8c);
    bytes.resize(bytes.size() + 10, 0x55);
    put(bytes, {0x80000000u, 60});
    bytes.resize(bytes.size() + 52, 0x20);
    put(bytes, {0x80000001u, 40, 1, flags, 7, 11, 12, 8500, 33333, latency});
    return bytes;
}

} // namespace

TEST_CASE("The age of a frame is found behind other blocks, when its flag is set") {
    CHECK(pipeLatencyOf(record(0x3f, 21500)) == doctest::Approx(0.0215));
    CHECK(pipeLatencyOf(record(0x20, 1)) == doctest::Approx(1e-6));
    CHECK_FALSE(pipeLatencyOf(record(0x1f, 21500)));
    CHECK_FALSE(pipeLatencyOf(record(0x3f, 0)));
    CHECK_FALSE(pipeLatencyOf(record(0x3f, 1000000))); // nothing is a second old
}

TEST_CASE("Metadata that is truncated, of another type, or has endless blocks is ignored") {
    const std::vector<uint8_t> good = record(0x3f, 21500);
    for (size_t n = 0; n < good.size(); ++n) {
        CHECK_FALSE(pipeLatencyOf(std::span(good).first(n)));
    }
    std::vector<uint8_t> bad = good;
    bad[10 + 12 + 4] = 0; // a block of no length
    CHECK_FALSE(pipeLatencyOf(bad));
    bad[10 + 12 + 4] = 255; // longer than all
    CHECK_FALSE(pipeLatencyOf(bad));
    bad = good;
    bad[10] = 12; // a bare header
    CHECK_FALSE(pipeLatencyOf(bad));
    bad[10] = 255;
    CHECK_FALSE(pipeLatencyOf(bad));
}
