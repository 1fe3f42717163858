// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_packet.h"

namespace fathom {

namespace {

constexpr uint8_t kFirst = '<', kLast = '>', kZero = 0x41;
constexpr size_t kLights = 13;
constexpr uint8_t kHoming = 1, kGreen = 2, kBlue = 4, kRed = 8;

} // namespace

std::array<uint8_t, kFalconPacket> encodeFalcon(const FalconCommand& command) noexcept {
    std::array<uint8_t, kFalconPacket> bytes{};
    bytes[0] = kFirst;
    for (size_t leg = 0; leg < 3; ++leg) {
        const auto value = static_cast<uint16_t>(command.motor[leg]);
        for (size_t nibble = 0; nibble < 4; ++nibble) {
            bytes[1 + 4 * leg + nibble] = static_cast<uint8_t>(kZero + (value >> (4 * nibble) & 15));
        }
    }
    const int lights = (command.homing ? kHoming : 0) | (command.green ? kGreen : 0) |
                       (command.blue ? kBlue : 0) | (command.red ? kRed : 0);
    bytes[kLights] = static_cast<uint8_t>(kZero + lights);
    bytes[14] = kZero;
    bytes[15] = kLast;
    return bytes;
}

std::optional<FalconState> decodeFalcon(std::span<const uint8_t, kFalconPacket> bytes) noexcept {
    if (bytes[0] != kFirst || bytes[15] != kLast) {
        return std::nullopt;
    }
    FalconState state;
    for (size_t leg = 0; leg < 3; ++leg) {
        uint16_t value = 0;
        for (size_t nibble = 0; nibble < 4; ++nibble) {
            const int n = bytes[1 + 4 * leg + nibble] - kZero;
            if (n < 0 || n > 15) {
                return std::nullopt;
            }
            value = static_cast<uint16_t>(value | n << (4 * nibble));
        }
        state.encoder[leg] = static_cast<int16_t>(value);
    }
    const int bits = bytes[kLights] - kZero;
    if (bits < 0 || bits > 127) {
        return std::nullopt;
    }
    state.buttons = static_cast<uint8_t>(bits & 15);
    state.homed = static_cast<uint8_t>(bits >> 4 & 7);
    return state;
}

void FalconStream::feed(std::span<const uint8_t> bytes) noexcept {
    for (const uint8_t byte : bytes) {
        take(byte);
    }
}

// '<' never occurs inside a packet, so it always starts one.
void FalconStream::take(uint8_t byte) noexcept {
    if (byte == kFirst) {
        faults_ += filled_ > 0 ? 1 : 0;
        filled_ = 0;
    } else if (filled_ == 0) {
        return;
    }
    packet_[filled_++] = byte;
    if (filled_ < kFalconPacket) {
        return;
    }
    filled_ = 0;
    if (const auto state = decodeFalcon(packet_)) {
        newest_ = *state;
        ++packets_;
    } else {
        ++faults_;
    }
}

} // namespace fathom
