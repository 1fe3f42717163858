// SPDX-License-Identifier: Apache-2.0
#include "devices/openni2/open_openni2.h"
#include "devices/openni2/openni2_camera.h"
#include "engine/types/error.h"

#include <set>

namespace fathom {

namespace {

// "depth 640x480 320x240", empty where it has no such sensor.
std::string sizesOf(openni::Device& device, openni::SensorType type, const char* name) {
    const openni::SensorInfo* sensor = device.getSensorInfo(type);
    if (sensor == nullptr) {
        return "";
    }
    const auto& modes = sensor->getSupportedVideoModes();
    std::set<std::pair<int, int>, std::greater<>> sizes; // the largest first
    for (int i = 0; i < modes.getSize(); ++i) {
        sizes.emplace(modes[i].getResolutionX(), modes[i].getResolutionY());
    }
    std::string text = name;
    for (const auto& [width, height] : sizes) {
        text += ' ' + std::to_string(width) + 'x' + std::to_string(height);
    }
    return text;
}

} // namespace

std::string openNi2Offer(uint16_t vendor, uint16_t product) {
    const OpenNi2Camera::Library library;
    openni::Array<openni::DeviceInfo> all;
    openni::OpenNI::enumerateDevices(&all);
    for (int i = 0; i < all.getSize(); ++i) {
        if (all[i].getUsbVendorId() != vendor || all[i].getUsbProductId() != product) {
            continue;
        }
        openni::Device device;
        if (device.open(all[i].getUri()) != openni::STATUS_OK) {
            refuseOpenNi2(all[i].getUri(), "device", "an accessible device that no other program uses");
        }
        const std::string depth = sizesOf(device, openni::SENSOR_DEPTH, "depth"),
                          colour = sizesOf(device, openni::SENSOR_COLOR, ", colour");
        device.close();
        return (depth.empty() ? "no depth" : depth) + colour + "; --source openni2:" + all[i].getUri();
    }
    throw BadInput("openni2", "driver", "no driver knows this camera",
                   "a driver for it in OpenNI2/Drivers (Debian's libopenni2-0 contains PrimeSense's)");
}

} // namespace fathom
