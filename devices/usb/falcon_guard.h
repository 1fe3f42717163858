// SPDX-License-Identifier: Apache-2.0
// The guardian of a Falcon: the one process that owns the device. Its other end is the engine, through a hand
// door; whatever becomes of the engine, the device gets zero force.
#pragma once

#include "devices/bridge/socket_server.h"
#include "devices/usb/falcon_drive.h"
#include "devices/usb/falcon_link.h"
#include "devices/usb/usb_ftdi.h"

#include <atomic>
#include <memory>
#include <optional>

namespace fathom {

// One thread. What the hardware does when this process itself dies between two packets is not known: no
// source says whether the firmware drops the motors by itself.
class FalconGuard {
public:
    // Where the door is made, and what a device that has just been switched on is given.
    struct Options {
        std::filesystem::path endpoint;
        std::filesystem::path firmware; // empty = none: a device that was just switched on is refused
    };
    // Opens device and door. Throws BadInput, Error, DeviceLost.
    explicit FalconGuard(const Options& options);
    ~FalconGuard(); // zero force

    // Exchanges until `stop`; then zero force. A device that goes away is looked for four times a second, and
    // the engine is told meanwhile.
    void run(const std::atomic<bool>& stop);

    const std::string& place() const noexcept { return place_; } // "usb 1-1"
    const FalconFigures& figures() const noexcept { return figures_; }
    uint64_t losses() const noexcept { return losses_; }
    const SocketServer& endpoint() const noexcept { return endpoint_; }

    static constexpr uint16_t kVendor = 0x0403, kProduct = 0xcb48;

private:
    struct Device {
        UsbFtdi port{kVendor, kProduct};
        FalconLink link{port};
    };
    void open();
    void close() noexcept;
    void exchange();
    void waitForDevice(const std::atomic<bool>& stop);
    void tellHoming(bool homed);

    std::vector<uint8_t> firmware_;
    std::unique_ptr<Device> device_;
    SocketServer endpoint_;
    FalconDrive drive_;
    HandSample sample_;
    bool placed_ = false;
    std::optional<bool> told_; // homed or not, as last logged
    FalconFigures figures_;    // of devices before this one, and at the end of all
    uint64_t losses_ = 0;
    std::string place_;
};

} // namespace fathom
