// SPDX-License-Identifier: Apache-2.0
// Common devices without a kernel driver, each with the reason and an alternative.
#pragma once

#include <cstdint>

namespace fathom {

// One device, or several whose product numbers share some bits.
struct ClosedDevice {
    uint16_t vendor = 0, product = 0, mask = 0xffff; // mask: significant bits of the product number
    const char* name = "";
    const char* why = ""; // one line: the reason and an alternative; empty = OpenNI2 may support it
};

// nullptr = unknown device. Sources of the numbers: the makers' public headers and drivers (OpenNI2,
// OrbbecSDK, libfreenect, libfreenect2, Azure Kinect SDK), the USB id list.
const ClosedDevice* closedDevice(uint16_t vendor, uint16_t product) noexcept;

} // namespace fathom
