// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/haptic/falcon_device.h"

#include <algorithm>

namespace fathom::vm {

namespace {

constexpr uint8_t kZero = 0x41;
constexpr std::array<int16_t, 3> kStill{};
constexpr size_t kPacket = 16, kUsbPacket = 64;

bool takeOne(std::atomic<int>& count) {
    if (count.load() <= 0) {
        return false;
    }
    count.fetch_sub(1);
    return true;
}

} // namespace

FalconDevice::FalconDevice(bool booted)
    : running_(booted) {
    description_.speed = UsbSpeed::Full;
    description_.device = deviceDescriptor(0x0403, 0xcb48, 0, 8, 0x0600);
    description_.strings = {{1, "FTDI"}, {2, "FALCON HAPTIC"}, {3, "SIM00001"}};
    Bytes body{9, 4, 0, 0, 2, 255, 255, 255, 2};
    append(body, {7, 5, 0x81, 2, kUsbPacket, 0, 0});
    append(body, {7, 5, 0x02, 2, kUsbPacket, 0, 0});
    description_.configuration = configurationDescriptor(1, body);
}

FalconDevice::~FalconDevice() {
    unplug();
}

void FalconDevice::setEncoders(const std::array<int16_t, 3>& encoders) {
    const std::lock_guard lock(mutex_);
    encoders_ = encoders;
}

std::array<int16_t, 3> FalconDevice::motors() const {
    const std::lock_guard lock(mutex_);
    return motors_;
}

std::vector<std::array<int16_t, 3>> FalconDevice::history() const {
    const std::lock_guard lock(mutex_);
    return history_;
}

Clock::time_point FalconDevice::released() const {
    const std::lock_guard lock(mutex_);
    return released_;
}

Bytes FalconDevice::firmware() const {
    const std::lock_guard lock(mutex_);
    return firmware_;
}

UsbReply FalconDevice::control(const UsbSetup& setup, const Bytes& /*out*/) {
    if (setup.requestType == 0xC0 && (setup.request == 5 || setup.request == 10)) {
        return {.data =
                    setup.request == 5 ? Bytes{0x01, 0x60} : Bytes{static_cast<uint8_t>(latencyMs.load())}};
    }
    if (setup.requestType != 0x40) {
        return UsbReply::stall();
    }
    if (setup.request == 9) {
        latencyMs = setup.value & 255;
    } else if (setup.request == 0) { // reset or purge
        toSend_.clear();
        received_.clear();
    }
    return {};
}

int FalconDevice::out(uint8_t /*endpoint*/, const Bytes& data) {
    if (!running_) {
        boot(data);
        return 0;
    }
    append(received_, data);
    while (received_.size() >= kPacket) {
        if (received_[0] == '<' && received_[15] == '>') {
            command(Bytes(received_.begin(), received_.begin() + kPacket));
            received_.erase(received_.begin(), received_.begin() + kPacket);
        } else {
            received_.erase(received_.begin());
        }
    }
    return 0;
}

void FalconDevice::boot(const Bytes& data) {
    if (data == Bytes{0x0a, 0x43, 0x0d}) {
        append(toSend_, {0x00, 0x0a, 0x44, 0x2c, 0x0d});
    } else if (data == Bytes{0x41}) {
        echoing_ = true;
        append(toSend_, data);
    } else if (echoing_) {
        const std::lock_guard lock(mutex_);
        for (const uint8_t byte : data) {
            toSend_.push_back(static_cast<int>(firmware_.size()) == wrongEchoAt.load() ? byte ^ 0x10 : byte);
            firmware_.push_back(byte);
        }
        running_ = firmware_.size() >= kFirmwareSize;
    }
}

void FalconDevice::command(const Bytes& packet) {
    const std::lock_guard lock(mutex_);
    const std::array<int16_t, 3> before = motors_;
    Bytes reply(kPacket, kZero);
    reply[0] = '<';
    reply[15] = '>';
    for (size_t leg = 0; leg < 3; ++leg) {
        int value = 0;
        for (size_t nibble = 0; nibble < 4; ++nibble) {
            value |= ((packet[1 + 4 * leg + nibble] - kZero) & 15) << (4 * nibble);
            reply[1 + 4 * leg + nibble] =
                static_cast<uint8_t>(kZero + (static_cast<uint16_t>(encoders_[leg]) >> (4 * nibble) & 15));
        }
        motors_[leg] = static_cast<int16_t>(value);
    }
    reply[13] = static_cast<uint8_t>(kZero + (homed && ((packet[13] - kZero) & 1) != 0 ? 0x70 : 0));
    history_.push_back(motors_);
    released_ = motors_ == kStill && before != kStill ? Clock::now() : released_;
    ++commands;
    unasked += awaits(1) ? 0 : 1;
    if (statusOnly || takeOne(faults.dropped)) {
        return;
    }
    if (takeOne(faults.wrong)) {
        reply[6] = 'z';
    }
    if (takeOne(faults.half)) {
        reply.resize(9);
    } else if (takeOne(faults.twofold)) {
        append(reply, Bytes(reply));
    }
    if (takeOne(faults.late)) {
        later_ = reply;
        laterAt_ = Clock::now() + std::chrono::milliseconds(faults.lateMs.load());
    } else {
        append(toSend_, reply);
    }
}

// Like an FT232R: sends the available bytes when the latency timer ends, or at once when a USB packet is
// full.
std::optional<UsbReply> FalconDevice::in(uint8_t /*endpoint*/, size_t room) {
    const auto now = Clock::now();
    if (!later_.empty() && now >= laterAt_) {
        append(toSend_, later_);
        later_.clear();
    }
    if (toSend_.size() < kUsbPacket - 2 && now - lastSent_ < timer()) {
        return std::nullopt;
    }
    statusPackets += toSend_.empty() ? 1 : 0;
    lastSent_ = now;
    return packed(room);
}

// USB packets of at most 64 bytes, each starting with two bytes of modem status.
UsbReply FalconDevice::packed(size_t room) {
    UsbReply reply;
    do {
        const size_t space = std::min(kUsbPacket, room - reply.data.size());
        const size_t count = std::min(space - 2, toSend_.size());
        append(reply.data, {0x01, 0x60});
        append(reply.data, Bytes(toSend_.begin(), toSend_.begin() + static_cast<long>(count)));
        toSend_.erase(toSend_.begin(), toSend_.begin() + static_cast<long>(count));
        if (count + 2 < kUsbPacket) {
            break;
        }
    } while (room - reply.data.size() > 2);
    return reply;
}

Clock::time_point FalconDevice::due() {
    const auto status = lastSent_ + timer();
    return later_.empty() ? status : std::min(status, laterAt_);
}

} // namespace fathom::vm
