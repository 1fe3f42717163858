// SPDX-License-Identifier: Apache-2.0
// What is plugged in, from sysfs alone: nothing is opened but to see whether it may be.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// One thing that is plugged in.
struct DeviceFile {
    // OpenNi: a camera that a driver of OpenNI2 may serve. SerialPort: where a manipulator may be. Closed:
    // known, but no driver here can serve it.
    enum class Kind { Falcon, SpaceMouse, Camera, OpenNi, SerialPort, Closed } kind = Kind::Camera;
    std::filesystem::path node; // what is opened: /dev/hidraw0, /dev/video0, /dev/bus/usb/001/004
    std::string name;           // as the device or its driver calls itself
    std::string place;          // "usb 1-1.2"; empty = not on USB
    uint16_t vendor = 0, product = 0;
    std::string refused; // why this user cannot open it, or nobody can use it; empty = may
};

// Sorted by kind, then node. `root`: where /sys and /dev are, for tests.
std::vector<DeviceFile> findDeviceFiles(const std::filesystem::path& root = "/");

// "0403:cb48"
std::string usbIdText(uint16_t vendor, uint16_t product);

} // namespace fathom
