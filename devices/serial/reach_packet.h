// SPDX-License-Identifier: Apache-2.0
// Packets of the Reach Alpha 5 arm on its serial line: COBS frames that end in a zero byte, CRC8 inside.
// Facts from the public driver alpha (evan-palmer, MIT); not verified on hardware.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace fathom {

struct ReachPacket {
    static constexpr size_t kMaxData = 64;

    uint8_t id = 0;     // 0x02 velocity, 0x03 position, 0x05 current, 0x60 request, ...
    uint8_t device = 0; // 1 jaws, 2 wrist, 3 elbow, 4 shoulder, 5 base, 0xFF all
    uint8_t size = 0;   // of data
    std::array<uint8_t, kMaxData> data{};

    static ReachPacket ofFloat(uint8_t id, uint8_t device,
                               float value) noexcept; // rad, rad/s, mA, mm for jaws
    std::optional<float> asFloat() const noexcept;    // for packets with four bytes of data
};

// Space for any packet on the line, including the final zero.
using ReachFrame = std::array<uint8_t, ReachPacket::kMaxData + 8>;

// CRC8: polynomial 0x4D, reflected, initial value 0, inverted result.
uint8_t reachCrc(std::span<const uint8_t> bytes) noexcept;

// Returns the number of bytes written to `out`, including the final zero; 0 when the packet has too much
// data.
size_t encodeReach(const ReachPacket& packet, ReachFrame& out) noexcept;

// Parses bytes into packets; a damaged packet is counted and dropped up to the next zero. Never allocates or
// throws.
class ReachReader {
public:
    // Returns a packet when `byte` completes a valid one.
    std::optional<ReachPacket> take(uint8_t byte) noexcept;
    uint64_t damaged() const noexcept { return damaged_; } // frames dropped: length, COBS or CRC wrong

private:
    std::optional<ReachPacket> decode() const noexcept;

    ReachFrame frame_{};
    size_t size_ = 0;
    bool tooLong_ = false;
    uint64_t damaged_ = 0;
};

} // namespace fathom
