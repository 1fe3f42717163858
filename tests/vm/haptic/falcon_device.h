// SPDX-License-Identifier: Apache-2.0
// A simulated Novint Falcon on the real USB stack: FT232R framing, latency timer, boot loader, firmware, and
// faults on request.
#pragma once

#include "tests/vm/usb_device.h"

#include <algorithm>
#include <array>
#include <mutex>

namespace fathom::vm {

// Every public member may be used by the test while the device is plugged in.
class FalconDevice final : public UsbDevice {
public:
    explicit FalconDevice(bool booted = true);
    ~FalconDevice() override;

    // Faults of the next answers; each answer counts down by one.
    struct Faults {
        std::atomic<int> half{0};    // only nine characters, in their own transfer
        std::atomic<int> twofold{0}; // two packets in one transfer
        std::atomic<int> late{0};    // delayed by lateMs
        std::atomic<int> dropped{0}; // missing; only modem status is sent
        std::atomic<int> wrong{0};   // a character out of range
        std::atomic<int> lateMs{15};
    } faults;
    std::atomic<bool> statusOnly{false}; // only modem status, always
    std::atomic<bool> homed{true};
    std::atomic<int> wrongEchoAt{-1}; // byte of the firmware
    std::atomic<int> latencyMs{16};
    std::atomic<int> leastMs{0}; // shortest time between two answers, regardless of the latency timer

    void setEncoders(const std::array<int16_t, 3>& encoders);
    std::array<int16_t, 3> motors() const;               // newest command
    std::vector<std::array<int16_t, 3>> history() const; // all of them
    Clock::time_point released() const;                  // time of the newest command that removed a force
    Bytes firmware() const;
    std::atomic<uint64_t> commands{0}, statusPackets{0};
    std::atomic<uint64_t> unasked{0}; // commands received while no IN transfer was pending

    static constexpr int kFirmwareSize = 300; // [bytes] runs when complete

private:
    UsbReply control(const UsbSetup& setup, const Bytes& out) override;
    int out(uint8_t endpoint, const Bytes& data) override;
    std::optional<UsbReply> in(uint8_t endpoint, size_t room) override;
    Clock::time_point due() override;
    void boot(const Bytes& data);
    void command(const Bytes& packet);
    UsbReply packed(size_t room);
    std::chrono::milliseconds timer() const {
        return std::chrono::milliseconds(std::max(latencyMs.load(), leastMs.load()));
    }

    mutable std::mutex mutex_; // guards the members below between test and device
    std::array<int16_t, 3> encoders_{}, motors_{};
    std::vector<std::array<int16_t, 3>> history_;
    Clock::time_point released_{};
    Bytes firmware_;

    bool running_;
    bool echoing_ = false;
    Bytes received_, toSend_;
    Bytes later_;
    Clock::time_point laterAt_{}, lastSent_ = Clock::now();
};

} // namespace fathom::vm
