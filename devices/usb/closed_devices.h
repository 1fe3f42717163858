// SPDX-License-Identifier: Apache-2.0
// Devices that people have and that no driver of the kernel serves, with the reason and the way that there
// is.
#pragma once

#include <cstdint>

namespace fathom {

// One device, or several whose product numbers share some bits.
struct ClosedDevice {
    uint16_t vendor = 0, product = 0, mask = 0xffff; // of the product number: the bits that count
    const char* name = "";
    const char* why = ""; // one line: what stops it and what can be done; empty = OpenNI2 may serve it
};

// nullptr = not one of them. Sources of the numbers: the makers' public headers and drivers (OpenNI2,
// OrbbecSDK, libfreenect, libfreenect2, Azure Kinect SDK), the USB id list.
const ClosedDevice* closedDevice(uint16_t vendor, uint16_t product) noexcept;

} // namespace fathom
