// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/closed_devices.h"

#include <algorithm>
#include <array>

namespace fathom {

namespace {

constexpr const char* kEndpoint =
    "its protocol is closed; a bridge program can use the maker's library (devices/bridge/README.md)";
constexpr const char* kOpenNi = "";

constexpr std::array kClosed{
    ClosedDevice{0x1451, 0, 0, "Force Dimension haptic device", kEndpoint},
    ClosedDevice{0x1d27, 0, 0, "PrimeSense depth camera (Xtion, Carmine)", kOpenNi},
    ClosedDevice{0x2bc5, 0x0400, 0xff00, "Orbbec depth camera (Astra)", kOpenNi},
    ClosedDevice{
        0x045e, 0x02ae, 0xffff, "Kinect camera",
        "the kernel gives its raw disparity without calibration: record it elsewhere as a TUM RGB-D folder"},
    ClosedDevice{0x045e, 0x02c4, 0xffff, "Kinect v2",
                 "the kernel has no driver: record it with libfreenect2"},
    ClosedDevice{0x045e, 0x02d9, 0xffff, "Kinect v2",
                 "the kernel has no driver: record it with libfreenect2"},
    ClosedDevice{0x045e, 0x097c, 0xffff, "Azure Kinect depth camera",
                 "a closed library computes its depth: record it with that library"},
};

} // namespace

const ClosedDevice* closedDevice(uint16_t vendor, uint16_t product) noexcept {
    const auto found = std::find_if(kClosed.begin(), kClosed.end(), [=](const ClosedDevice& d) {
        return d.vendor == vendor && (product & d.mask) == d.product;
    });
    return found == kClosed.end() ? nullptr : &*found;
}

} // namespace fathom
