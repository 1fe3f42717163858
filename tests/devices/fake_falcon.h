// SPDX-License-Identifier: Apache-2.0
// A simulated Falcon behind a port without USB: boot loader, firmware, and faults of each.
#pragma once

#include "devices/usb/falcon_packet.h"
#include "devices/usb/ftdi_port.h"
#include "engine/types/error.h"

#include <deque>
#include <string>

namespace fathom::testing {

class FakeFalcon final : public FtdiPort {
public:
    explicit FakeFalcon(bool booted)
        : running(booted) {}

    bool running;                               // firmware runs
    std::vector<uint8_t> firmware;              // received by the boot loader
    std::vector<std::string> requests;          // "3=21" and so on
    std::vector<std::array<int16_t, 3>> motors; // of every command that came
    FalconState state{{10, 20, 30}, 0, 7};
    std::string greeting = std::string("\0\n\x44,\r", 5); // the answer to it
    bool wrongSpeedAnswer = false;
    size_t wrongEchoAt = SIZE_MAX; // byte of the firmware
    size_t runsAfter = SIZE_MAX;   // bytes of firmware
    size_t diesAfter = SIZE_MAX;   // bytes of firmware
    bool mute = false, unplugged = false, deaf = false;
    int copies = 1;         // answers per command
    size_t most = SIZE_MAX; // most bytes per take()

    void control(FtdiRequest request, uint16_t value) override {
        check();
        requests.push_back(std::to_string(static_cast<int>(request)) + "=" + std::to_string(value));
        if (request == FtdiRequest::Reset && value == 2) {
            out_.clear();
        }
    }
    bool send(std::span<const uint8_t> bytes) override {
        check();
        if (deaf) {
            return false;
        }
        running ? answer(bytes) : boot(bytes);
        return true;
    }
    void wait(std::chrono::microseconds) override { check(); }
    void take(std::vector<uint8_t>& bytes) override {
        for (size_t i = 0; i < most && !out_.empty(); ++i) {
            bytes.push_back(out_.front());
            out_.pop_front();
        }
    }

private:
    void check() const {
        if (unplugged) {
            throw DeviceLost("fake: unplugged");
        }
    }
    void say(std::span<const uint8_t> bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }
    void answer(std::span<const uint8_t> bytes) {
        if (bytes.size() != kFalconPacket) {
            return;
        }
        const auto command = decodeFalcon(bytes.first<kFalconPacket>());
        if (command) {
            motors.push_back(command->encoder);
        }
        FalconCommand reply;
        reply.motor = state.encoder;
        auto packet = encodeFalcon(reply);
        packet[13] = static_cast<uint8_t>(0x41 + (state.homed << 4 | state.buttons));
        for (int i = 0; i < copies && !mute; ++i) {
            say(packet);
        }
    }
    void boot(std::span<const uint8_t> bytes) {
        if (bytes.size() == 3 && bytes[0] == 0x0a) {
            say({reinterpret_cast<const uint8_t*>(greeting.data()), greeting.size()});
            return;
        }
        if (!greeted_) {
            if (bytes.size() == 1 && bytes[0] == 0x41) {
                greeted_ = true;
                say(wrongSpeedAnswer ? std::span<const uint8_t>(kWrong) : bytes);
            }
            return; // an exchange before the firmware: no answer
        }
        if (firmware.size() >= diesAfter) {
            return;
        }
        for (const uint8_t byte : bytes) {
            out_.push_back(firmware.size() == wrongEchoAt ? static_cast<uint8_t>(byte ^ 1) : byte);
            firmware.push_back(byte);
        }
        running = firmware.size() >= runsAfter;
    }
    static constexpr std::array<uint8_t, 1> kWrong{0x3f};
    std::deque<uint8_t> out_;
    bool greeted_ = false;
};

} // namespace fathom::testing
