// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/reach_packet.h"

#include <algorithm>
#include <bit>

namespace fathom {

namespace {

constexpr uint8_t kReversedPolynomial = 0xB2; // 0x4D, bit-reversed
constexpr size_t kTail = 4;                   // id, device, length, CRC

} // namespace

uint8_t reachCrc(std::span<const uint8_t> bytes) noexcept {
    uint8_t crc = 0;
    for (uint8_t byte : bytes) {
        crc = static_cast<uint8_t>(crc ^ byte);
        for (int bit = 0; bit < 8; ++bit) {
            crc = static_cast<uint8_t>((crc >> 1) ^ ((crc & 1) != 0 ? kReversedPolynomial : 0));
        }
    }
    return static_cast<uint8_t>(~crc);
}

ReachPacket ReachPacket::ofFloat(uint8_t id, uint8_t device, float value) noexcept {
    ReachPacket packet{id, device, 4, {}};
    const auto bits = std::bit_cast<uint32_t>(value);
    for (size_t k = 0; k < 4; ++k) {
        packet.data[k] = static_cast<uint8_t>(bits >> (8 * k));
    }
    return packet;
}

std::optional<float> ReachPacket::asFloat() const noexcept {
    if (size != 4) {
        return std::nullopt;
    }
    uint32_t bits = 0;
    for (size_t k = 0; k < 4; ++k) {
        bits |= static_cast<uint32_t>(data[k]) << (8 * k);
    }
    return std::bit_cast<float>(bits);
}

size_t encodeReach(const ReachPacket& packet, ReachFrame& out) noexcept {
    if (packet.size > ReachPacket::kMaxData) {
        return 0;
    }
    std::array<uint8_t, ReachPacket::kMaxData + kTail> raw{};
    std::copy_n(packet.data.begin(), packet.size, raw.begin());
    const size_t length = packet.size + kTail;
    raw[packet.size] = packet.id;
    raw[packet.size + 1u] = packet.device;
    raw[packet.size + 2u] = static_cast<uint8_t>(length);
    raw[packet.size + 3u] = reachCrc({raw.data(), length - 1});
    // COBS; packets are shorter than 254 bytes, so no block is ever full.
    size_t mark = 0, at = 1;
    uint8_t distance = 1;
    for (size_t i = 0; i < length; ++i) {
        if (raw[i] != 0) {
            out[at++] = raw[i];
            ++distance;
            continue;
        }
        out[mark] = distance;
        mark = at++;
        distance = 1;
    }
    out[mark] = distance;
    out[at++] = 0;
    return at;
}

std::optional<ReachPacket> ReachReader::decode() const noexcept {
    std::array<uint8_t, ReachPacket::kMaxData + 8> raw{};
    size_t length = 0;
    for (size_t at = 0; at < size_;) {
        const size_t block = frame_[at];
        if (at + block > size_) {
            return std::nullopt;
        }
        for (size_t k = 1; k < block; ++k) {
            raw[length++] = frame_[at + k];
        }
        at += block;
        if (at < size_) {
            raw[length++] = 0;
        }
    }
    if (length < kTail || length > ReachPacket::kMaxData + kTail || raw[length - 2] != length ||
        reachCrc({raw.data(), length - 1}) != raw[length - 1]) {
        return std::nullopt;
    }
    ReachPacket packet{raw[length - 4], raw[length - 3], static_cast<uint8_t>(length - kTail), {}};
    std::copy_n(raw.begin(), packet.size, packet.data.begin());
    return packet;
}

std::optional<ReachPacket> ReachReader::take(uint8_t byte) noexcept {
    if (byte != 0) {
        if (size_ == frame_.size()) {
            tooLong_ = true;
        } else {
            frame_[size_++] = byte;
        }
        return std::nullopt;
    }
    std::optional<ReachPacket> packet;
    if (size_ > 0) { // consecutive zeros are an idle line
        packet = tooLong_ ? std::nullopt : decode();
        damaged_ += packet ? 0 : 1;
    }
    size_ = 0;
    tooLong_ = false;
    return packet;
}

} // namespace fathom
