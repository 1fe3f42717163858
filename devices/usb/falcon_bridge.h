// SPDX-License-Identifier: Apache-2.0
// The bridge of a Falcon: the only process that owns the device. The engine connects through a hand
// socket; when the engine fails in any way, the device gets zero force.
#pragma once

#include "devices/bridge/device_bridge.h"
#include "devices/usb/falcon_drive.h"
#include "devices/usb/falcon_link.h"
#include "devices/usb/usb_ftdi.h"

#include <memory>
#include <optional>

namespace fathom {

// One thread. It is unknown what the hardware does when this process itself dies between two packets: no
// source states whether the firmware stops the motors.
class FalconBridge final : public DeviceBridge {
public:
    // Path of the socket, and the firmware for a device after power-on.
    struct Options {
        std::filesystem::path endpoint;
        std::filesystem::path firmware; // empty = none: a device without firmware is rejected
    };
    // Opens the device and the socket. Throws BadInput, Error, DeviceLost.
    explicit FalconBridge(const Options& options);
    ~FalconBridge() override; // sends zero force

    const std::string& place() const noexcept { return place_; } // "usb 1-1"
    const FalconFigures& figures() const noexcept { return figures_; }

    static constexpr uint16_t kVendor = 0x0403, kProduct = 0xcb48;

private:
    struct Device {
        UsbFtdi port{"falcon", kVendor, kProduct};
        FalconLink link{port};
    };
    void open() override;
    bool isOpen() const noexcept override { return device_ != nullptr; }
    void close() noexcept override;
    void exchange() override;
    void logHoming(bool homed);

    std::vector<uint8_t> firmware_;
    std::unique_ptr<Device> device_;
    FalconDrive drive_;
    bool placed_ = false;
    std::optional<bool> loggedHomed_; // homed or not, as last logged
    FalconFigures figures_;           // sum over earlier devices; at the end, over all
    std::string place_;
};

} // namespace fathom
