// SPDX-License-Identifier: Apache-2.0
#include "apps/devices/hand_devices.h"

#include "apps/binding/open_hand.h"
#include "devices/bridge/device_socket.h"
#include "devices/openni2/open_openni2.h"
#include "devices/usb/device_files.h"
#include "devices/v4l2/pixel_format.h"
#include "devices/v4l2/video_node.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace fathom {

namespace {

const char* kindOf(DeviceFile::Kind kind) {
    switch (kind) {
    case DeviceFile::Kind::Falcon:
        return "haptic  ";
    case DeviceFile::Kind::SpaceMouse:
        return "hand    ";
    case DeviceFile::Kind::SerialPort:
        return "serial  ";
    case DeviceFile::Kind::Closed:
        return "other   ";
    case DeviceFile::Kind::OpenNi:
    case DeviceFile::Kind::Camera:
        break;
    }
    return "camera  ";
}

std::string formatNames(const VideoNode& node, std::span<const uint32_t> formats) {
    std::string text;
    for (const uint32_t format : formats) {
        if (node.offers(format)) {
            text += (text.empty() ? "" : ", ") + fourccName(format);
            for (const VideoSize size : node.sizes(format)) {
                text += ' ';
                text += sizeName(size);
            }
        }
    }
    return text;
}

std::string cameraCapability(const std::filesystem::path& file) {
    try {
        const VideoNode node(file);
        const std::string depth = formatNames(node, declaredDepthFormats()),
                          colour = formatNames(node, colourFormats());
        if (!depth.empty()) {
            return "depth " + depth + "; --source v4l2:" + file.string();
        }
        return colour.empty() ? "REFUSED: no supported depth or colour format; it has " + node.offer()
                              : "colour only: " + colour + "; --source v4l2:DEPTH,colour=" + file.string();
    } catch (const BadInput& e) {
        return std::string("REFUSED: ") + e.what();
    }
}

std::string openNiCapability(const DeviceFile& file) {
    try {
        return openNi2Offer(file.vendor, file.product);
    } catch (const BadInput& e) {
        return std::string("REFUSED: ") + e.what();
    }
}

std::string capabilityOf(const DeviceFile& file) {
    switch (file.kind) {
    case DeviceFile::Kind::Falcon:
        return axesOf("falcon") + "; through `fathom guard falcon`";
    case DeviceFile::Kind::SpaceMouse:
        return axesOf("none") + "; --hand-device spacemouse:" + file.node.string();
    case DeviceFile::Kind::SerialPort:
        return "can be opened; may connect a manipulator (a port cannot identify it); --arm " +
               file.node.string();
    case DeviceFile::Kind::OpenNi:
        return openNiCapability(file);
    case DeviceFile::Kind::Camera:
    case DeviceFile::Kind::Closed:
        break;
    }
    return cameraCapability(file.node);
}

void print(std::ostream& out, const DeviceFile& file) {
    out << kindOf(file.kind) << file.node.string() << "  "
        << (file.name.empty() ? "without a name" : file.name);
    if (file.vendor != 0) {
        out << ", " << usbIdText(file.vendor, file.product) << " at " << file.place;
    }
    out << "\n          " << (file.refused.empty() ? capabilityOf(file) : "REFUSED: " + file.refused) << "\n";
}

// Sockets of bridges in the user's run-time folder.
int printEndpoints(std::ostream& out, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
        if (it->path().extension() == ".door" && it->is_socket(error)) {
            found.push_back(it->path());
        }
    }
    std::sort(found.begin(), found.end());
    for (const auto& path : found) {
        DeviceSocket endpoint;
        const int refused = DeviceSocket::tryConnect(path, endpoint);
        out << "door    " << path.string() << "\n          "
            << (refused == 0              ? "a bridge listens; --hand-device " + path.string()
                : refused == ECONNREFUSED ? std::string("REFUSED: its bridge has ended")
                                          : std::string("REFUSED: ") + std::strerror(refused))
            << "\n";
    }
    return static_cast<int>(found.size());
}

} // namespace

void printHandDevices(std::ostream& out, const std::filesystem::path& root,
                      const std::filesystem::path& endpoints) {
    auto files = findDeviceFiles(root);
    std::erase_if(files, [](const DeviceFile& f) { // part of the camera listed before it
        return f.kind == DeviceFile::Kind::Camera && isMetadataNode(f.node);
    });
    for (const DeviceFile& file : files) {
        print(out, file);
    }
    if (files.empty() && printEndpoints(out, endpoints) == 0) {
        out << "no camera, haptic device or bridge socket found\n";
    } else if (!files.empty()) {
        printEndpoints(out, endpoints);
    }
}

} // namespace fathom
