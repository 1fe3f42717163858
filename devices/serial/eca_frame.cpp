// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/eca_frame.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr uint8_t kStart = 0xE7, kEnd = 0xE5;
constexpr size_t kFirst = 4, kBlock = 9, kCheck = 49;

void putBig(uint8_t* at, uint16_t value) noexcept {
    at[0] = static_cast<uint8_t>(value >> 8);
    at[1] = static_cast<uint8_t>(value & 0xff);
}

uint16_t big(const uint8_t* at) noexcept {
    return static_cast<uint16_t>(at[0] << 8 | at[1]);
}

void putLittle(uint8_t* at, uint16_t value) noexcept {
    at[0] = static_cast<uint8_t>(value & 0xff);
    at[1] = static_cast<uint8_t>(value >> 8);
}

uint16_t little(const uint8_t* at) noexcept {
    return static_cast<uint16_t>(at[1] << 8 | at[0]);
}

EcaBytes closed(EcaBytes frame) noexcept {
    frame[0] = kStart;
    frame[kCheck] = ecaChecksum(frame);
    frame[kCheck + 1] = kEnd;
    return frame;
}

} // namespace

uint8_t ecaChecksum(const EcaBytes& frame) noexcept {
    uint32_t sum = 0;
    for (size_t i = 0; i < kCheck; ++i) {
        sum += frame[i];
    }
    return static_cast<uint8_t>(sum % 255 - sum / 255);
}

EcaBytes encodeEca(const std::array<EcaDemand, kEcaJoints>& demands) noexcept {
    EcaBytes frame{};
    for (size_t j = 0; j < kEcaJoints; ++j) {
        uint8_t* block = frame.data() + kFirst + kBlock * j;
        block[1] = static_cast<uint8_t>(demands[j].kind);
        putBig(block + 2, demands[j].speed);
        putBig(block + 4, demands[j].speedLimit);
        putBig(block + 6, demands[j].currentLimit);
    }
    return closed(frame);
}

EcaBytes encodeEca(const std::array<EcaStatus, kEcaJoints>& status) noexcept {
    EcaBytes frame{};
    for (size_t j = 0; j < kEcaJoints; ++j) {
        uint8_t* block = frame.data() + kFirst + kBlock * j;
        putLittle(block + 1, status[j].encoder);
        putLittle(block + 3, status[j].speed);
        block[5] = status[j].current;
        block[6] = status[j].temperature;
    }
    return closed(frame);
}

std::array<EcaDemand, kEcaJoints> demandsOf(const EcaBytes& frame) noexcept {
    std::array<EcaDemand, kEcaJoints> demands;
    for (size_t j = 0; j < kEcaJoints; ++j) {
        const uint8_t* block = frame.data() + kFirst + kBlock * j;
        demands[j] = {static_cast<EcaDemand::Kind>(block[1]), big(block + 2), big(block + 4), big(block + 6)};
    }
    return demands;
}

std::array<EcaStatus, kEcaJoints> statusOf(const EcaBytes& frame) noexcept {
    std::array<EcaStatus, kEcaJoints> status;
    for (size_t j = 0; j < kEcaJoints; ++j) {
        const uint8_t* block = frame.data() + kFirst + kBlock * j;
        status[j] = {little(block + 1), little(block + 3), block[5], block[6]};
    }
    return status;
}

// Drops the first byte and everything up to the next start byte.
void EcaReader::resync() noexcept {
    ++damaged_;
    const auto end = frame_.begin() + static_cast<std::ptrdiff_t>(size_);
    const auto next = std::find(frame_.begin() + 1, end, kStart);
    size_ = static_cast<size_t>(std::copy(next, end, frame_.begin()) - frame_.begin());
}

std::optional<EcaBytes> EcaReader::take(uint8_t byte) noexcept {
    frame_[size_++] = byte;
    while (size_ > 0) {
        const size_t head = std::min<size_t>(size_, 4);
        const bool begins =
            frame_[0] == kStart &&
            std::all_of(frame_.begin() + 1, frame_.begin() + static_cast<std::ptrdiff_t>(head),
                        [](uint8_t b) { return b == 0; });
        if (!begins) {
            resync();
            continue;
        }
        if (size_ < frame_.size()) {
            return std::nullopt;
        }
        if (frame_[kCheck] == ecaChecksum(frame_) && frame_[kCheck + 1] == kEnd) {
            size_ = 0;
            return frame_;
        }
        resync();
    }
    return std::nullopt;
}

} // namespace fathom
