// SPDX-License-Identifier: Apache-2.0
// An FTDI port over libusb with one IN transfer pending at all times, so that answers are received without
// polling.
#pragma once

#include "devices/usb/ftdi_port.h"

#include <array>
#include <string>

struct libusb_context;
struct libusb_device_handle;
struct libusb_transfer;

namespace fathom {

// One thread. Source of endpoints and framing: FT232R, interface 0, bulk OUT 2, bulk IN 1, each IN packet of
// at most 64 bytes begins with two bytes of modem status.
class UsbFtdi final : public FtdiPort {
public:
    // The first device with these ids; messages call it `name`. Throws BadInput when there is none,
    // permission is missing (names the udev rule), or it is in use.
    UsbFtdi(const std::string& name, uint16_t vendor, uint16_t product);
    UsbFtdi(const UsbFtdi&) = delete;
    UsbFtdi& operator=(const UsbFtdi&) = delete;
    ~UsbFtdi() override; // flushes pending output, 50 ms at most

    void control(FtdiRequest request, uint16_t value) override;
    bool send(std::span<const uint8_t> bytes) override;
    void wait(std::chrono::microseconds most) override;
    void take(std::vector<uint8_t>& bytes) override;

    const std::string& place() const noexcept { return place_; } // "usb 1-1.2"

private:
    void open(const std::string& name, uint16_t vendor, uint16_t product);
    void handleEvents(std::chrono::microseconds most) noexcept;
    void onReceived() noexcept;
    void onSent() noexcept;
    void submitReceive() noexcept;
    void close() noexcept;
    void checkThere() const;

    static constexpr size_t kUsbPacket = 64;
    static constexpr int kMaxErrors = 8; // consecutive errors until the device counts as lost

    libusb_context* context_ = nullptr;
    libusb_device_handle* handle_ = nullptr;
    libusb_transfer* in_ = nullptr;
    libusb_transfer* out_ = nullptr;
    std::array<uint8_t, 8 * kUsbPacket> inBytes_{};
    std::array<uint8_t, kUsbPacket> outBytes_{};
    std::vector<uint8_t> payload_;
    bool inPending_ = false, outPending_ = false, gone_ = false, closing_ = false;
    int errors_ = 0, event_ = 0;
    std::string place_;
};

} // namespace fathom
