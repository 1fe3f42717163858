// SPDX-License-Identifier: Apache-2.0
// The wire format of a Novint Falcon with running firmware: 16 characters each way.
// Source: facts stated in the open driver libnifalcon; not verified on hardware.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace fathom {

inline constexpr size_t kFalconPacket = 16; // bytes
// Largest magnitude of a motor command.
inline constexpr int kFalconMotorLimit = 4096;

// Command to the device.
struct FalconCommand {
    std::array<int16_t, 3> motor{}; // -4096..4096, one per leg
    bool homing = true;             // must be set in every packet for the device to stay homed
    bool green = false, blue = false, red = false;
};

// State of the device.
struct FalconState {
    std::array<int16_t, 3> encoder{}; // counts since home, one per leg
    uint8_t buttons = 0;              // bits: 1 plus, 2 forward, 4 centre, 8 minus
    uint8_t homed = 0;                // one bit per leg

    bool allHomed() const noexcept { return homed == 7; }
};

// '<', three int16 as four nibbles each with the least first, lights, 'A', '>'; a nibble n is 0x41 + n.
std::array<uint8_t, kFalconPacket> encodeFalcon(const FalconCommand& command) noexcept;

// Empty when the characters do not form a packet.
std::optional<FalconState> decodeFalcon(std::span<const uint8_t, kFalconPacket> bytes) noexcept;

// Extracts packets from a byte stream: partial packets, several at once, noise before '<'.
class FalconStream {
public:
    void feed(std::span<const uint8_t> bytes) noexcept;
    void clear() noexcept { filled_ = 0; }

    const FalconState& newest() const noexcept { return newest_; }
    uint64_t packets() const noexcept { return packets_; } // valid ones
    uint64_t faults() const noexcept { return faults_; }   // truncated, or with invalid characters

private:
    void take(uint8_t byte) noexcept;

    std::array<uint8_t, kFalconPacket> packet_{};
    size_t filled_ = 0;
    FalconState newest_;
    uint64_t packets_ = 0, faults_ = 0;
};

} // namespace fathom
