// SPDX-License-Identifier: Apache-2.0
// Lists attached devices from sysfs; opens a node only to test permission.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// One attached device.
struct DeviceFile {
    // OpenNi: a camera that OpenNI2 may support. SerialPort: possibly a manipulator. Closed: known, but
    // without a driver here.
    enum class Kind { Falcon, SpaceMouse, Camera, OpenNi, SerialPort, Closed } kind = Kind::Camera;
    std::filesystem::path node; // node to open: /dev/hidraw0, /dev/video0, /dev/bus/usb/001/004
    std::string name;           // as reported by the device or its driver
    std::string place;          // "usb 1-1.2"; empty = not on USB
    uint16_t vendor = 0, product = 0;
    std::string refused; // why it cannot be opened or used; empty = usable
};

// Sorted by kind, then node. `root`: parent of /sys and /dev, for tests.
std::vector<DeviceFile> findDeviceFiles(const std::filesystem::path& root = "/");

// "0403:cb48"
std::string usbIdText(uint16_t vendor, uint16_t product);

} // namespace fathom
