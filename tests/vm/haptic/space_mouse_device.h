// SPDX-License-Identifier: Apache-2.0
// A simulated SpaceNavigator on the real USB stack: an HID device whose reports a test sets.
#pragma once

#include "tests/vm/usb_device.h"

#include <array>
#include <mutex>
#include <span>

namespace fathom::vm {

class SpaceMouseDevice final : public UsbDevice {
public:
    // Translation and rotation in one report, like later models; else in two.
    explicit SpaceMouseDevice(bool combined = false);
    ~SpaceMouseDevice() override { unplug(); }

    // Reported every 8 ms from now on. Zeros are reported once, then nothing, like the device.
    void deflect(const std::array<int16_t, 3>& shift, const std::array<int16_t, 3>& tick);
    void press(uint8_t buttons);
    std::atomic<bool> silent{false}; // no report at all, though deflected
    std::atomic<bool> halves{false}; // motion reports are truncated to four bytes

private:
    UsbReply control(const UsbSetup& setup, const Bytes& out) override;
    std::optional<UsbReply> in(uint8_t endpoint, size_t room) override;
    Clock::time_point due() override { return due_; }
    Bytes motion(uint8_t id, std::span<const int16_t> axes) const;
    void queueMotion();

    bool combined_;
    Bytes reportDescriptor_;
    std::mutex mutex_;
    std::array<int16_t, 3> shift_{}, tick_{};
    bool zeroReported_ = true;
    std::deque<Bytes> queue_;
    Clock::time_point due_ = Clock::now();
};

} // namespace fathom::vm
