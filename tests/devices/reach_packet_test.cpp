// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/reach_packet.h"

#include <doctest/doctest.h>
#include <random>
#include <vector>

using namespace fathom;

namespace {

std::vector<uint8_t> encoded(const ReachPacket& packet) {
    ReachFrame frame;
    const size_t size = encodeReach(packet, frame);
    return {frame.begin(), frame.begin() + static_cast<long>(size)};
}

std::vector<ReachPacket> read(ReachReader& reader, const std::vector<uint8_t>& line) {
    std::vector<ReachPacket> packets;
    for (uint8_t byte : line) {
        if (const auto packet = reader.take(byte)) {
            packets.push_back(*packet);
        }
    }
    return packets;
}

} // namespace

TEST_CASE("The published frames of the arm are reproduced byte for byte") {
    const std::vector<uint8_t> request{0x03, 0x60, 0x01, 0x05}, other{0xFF, 0x12, 0xAD, 0x23, 0x56};
    CHECK(reachCrc(request) == 0x52);
    CHECK(reachCrc(other) == 0xF3);
    ReachPacket position{0x60, 0x01, 1, {0x03}};
    CHECK(encoded(position) == std::vector<uint8_t>{0x06, 0x03, 0x60, 0x01, 0x05, 0x52, 0x00});
    ReachReader reader;
    const auto packets = read(reader, {0x09, 0x01, 0x02, 0x03, 0x04, 0x01, 0xFF, 0x08, 0x5D, 0x00});
    REQUIRE(packets.size() == 1);
    CHECK(packets[0].id == 0x01);
    CHECK(packets[0].device == 0xFF);
    CHECK(packets[0].size == 4);
    CHECK(packets[0].data[3] == 0x04);
}

TEST_CASE("Every packet survives a round trip, including zeros, no data and the largest size") {
    std::mt19937_64 random(1);
    ReachReader reader;
    for (size_t size = 0; size <= ReachPacket::kMaxData; ++size) {
        ReachPacket packet{0x03, 0x05, static_cast<uint8_t>(size), {}};
        for (size_t k = 0; k < size; ++k) {
            packet.data[k] = static_cast<uint8_t>(random() % 3);
        }
        const auto packets = read(reader, encoded(packet));
        REQUIRE(packets.size() == 1);
        CHECK(packets[0].data == packet.data);
        CHECK(packets[0].size == size);
    }
    CHECK(reader.damaged() == 0);
    const auto packets = read(reader, encoded(ReachPacket::ofFloat(0x03, 2, -1.25f)));
    CHECK(packets.at(0).asFloat() == -1.25f);
    CHECK_FALSE(ReachPacket{0x03, 2, 3, {}}.asFloat());
    ReachFrame frame;
    CHECK(encodeReach({0x03, 2, ReachPacket::kMaxData + 1, {}}, frame) == 0);
}

TEST_CASE("Lost, changed and added bytes damage only the frame that they hit") {
    std::mt19937_64 random(2);
    ReachReader reader;
    size_t wrong = 0, good = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::vector<uint8_t> line = encoded(ReachPacket::ofFloat(0x03, 4, 0.001f * static_cast<float>(i)));
        const size_t at = random() % (line.size() - 1); // never the closing zero: that would join two frames
        switch (i % 4) {
        case 0:
            line[at] = static_cast<uint8_t>(line[at] ^ (1u << random() % 8));
            break;
        case 1:
            line.erase(line.begin() + static_cast<long>(at));
            break;
        case 2:
            line.insert(line.begin() + static_cast<long>(at), static_cast<uint8_t>(random() | 1u));
            break;
        default:
            break;
        }
        for (const ReachPacket& packet : read(reader, line)) {
            const bool right = packet.id == 0x03 && packet.asFloat() == 0.001f * static_cast<float>(i);
            wrong += right ? 0 : 1;
            good += right && i % 4 == 3 ? 1 : 0;
        }
    }
    CHECK(good == 5000);          // every untouched frame
    CHECK(wrong <= 15'000 / 256); // what eight bits of CRC and the length cannot see
    CHECK(reader.damaged() > 14'000);
    std::vector<uint8_t> endless(5000, 0x07);
    CHECK(read(reader, endless).empty());
    CHECK(read(reader, {0x00}).empty());
    CHECK(read(reader, encoded(ReachPacket::ofFloat(0x02, 1, 1.0f))).size() == 1);
}
