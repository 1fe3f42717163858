// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/device_files.h"

#include "devices/usb/closed_devices.h"
#include "devices/usb/space_mouse.h"
#include "devices/usb/udev_rule.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <tuple>

#include <unistd.h>

namespace fathom {

namespace fs = std::filesystem;

namespace {

constexpr uint16_t kFalconVendor = 0x0403, kFalconProduct = 0xcb48;

std::string lineOf(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

std::optional<uint16_t> hexOf(const std::string& text) {
    uint16_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// The USB device of a sysfs node: the nearest parent folder with idVendor.
std::optional<fs::path> usbParent(const fs::path& device) {
    std::error_code error;
    fs::path folder = fs::canonical(device, error);
    for (; !error && folder.has_relative_path(); folder = folder.parent_path()) {
        if (fs::exists(folder / "idVendor", error)) {
            return folder;
        }
    }
    return std::nullopt;
}

void fillUsb(const fs::path& folder, DeviceFile& file) {
    file.vendor = hexOf(lineOf(folder / "idVendor")).value_or(0);
    file.product = hexOf(lineOf(folder / "idProduct")).value_or(0);
    file.place = "usb " + folder.filename().string();
    if (file.name.empty()) {
        file.name = lineOf(folder / "product");
    }
}

std::string refusalOf(const fs::path& node, int mode, const char* remedy = kUdevRuleHint) {
    if (::access(node.c_str(), mode) == 0) {
        return {};
    }
    return errno == EACCES || errno == EPERM ? std::string("no permission: ") + remedy
                                             : std::string(std::strerror(errno));
}

std::vector<fs::path> entries(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        found.push_back(it->path());
    }
    return found;
}

std::string numberText(const std::string& text) {
    int value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return printed("%03d", value);
}

// Devices identified by their USB numbers.
void findOnBus(const fs::path& root, std::vector<DeviceFile>& out) {
    for (const fs::path& device : entries(root / "sys/bus/usb/devices")) {
        DeviceFile file;
        fillUsb(device, file);
        file.node = root / "dev/bus/usb" / numberText(lineOf(device / "busnum")) /
                    numberText(lineOf(device / "devnum"));
        if (file.vendor == kFalconVendor && file.product == kFalconProduct) {
            file.kind = DeviceFile::Kind::Falcon;
            file.refused = refusalOf(file.node, R_OK | W_OK);
            out.push_back(file);
        } else if (const ClosedDevice* closed = closedDevice(file.vendor, file.product)) {
            const bool openNi = *closed->why == '\0';
            file.kind = openNi ? DeviceFile::Kind::OpenNi : DeviceFile::Kind::Closed;
            file.name = file.name.empty() ? closed->name : file.name;
            file.refused = openNi ? refusalOf(file.node, R_OK | W_OK) : closed->why;
            out.push_back(file);
        }
    }
}

// USB serial ports, and on-board ports with a chip behind them.
void findSerialPorts(const fs::path& root, std::vector<DeviceFile>& out) {
    for (const fs::path& entry : entries(root / "sys/class/tty")) {
        const std::string tty = entry.filename().string();
        DeviceFile file;
        file.kind = DeviceFile::Kind::SerialPort;
        file.node = root / "dev" / tty;
        const bool onUsb = tty.starts_with("ttyUSB") || tty.starts_with("ttyACM");
        if (const auto usb = onUsb ? usbParent(entry / "device") : std::nullopt) {
            fillUsb(*usb, file);
        } else if (const std::string chip = lineOf(entry / "type"); chip.empty() || chip == "0") {
            continue;
        }
        file.name = file.name.empty() ? "serial port" : file.name;
        file.refused = refusalOf(file.node, R_OK | W_OK, onUsb ? kUdevRuleHint : kSerialGroupHint);
        out.push_back(file);
    }
}

void findSpaceMice(const fs::path& root, std::vector<DeviceFile>& out) {
    for (const fs::path& entry : entries(root / "sys/class/hidraw")) {
        DeviceFile file;
        file.kind = DeviceFile::Kind::SpaceMouse;
        const auto usb = usbParent(entry / "device");
        if (!usb) {
            continue;
        }
        fillUsb(*usb, file);
        if (isSpaceMouse(file.vendor, file.product)) {
            file.node = root / "dev" / entry.filename();
            file.refused = refusalOf(file.node, R_OK);
            out.push_back(file);
        }
    }
}

void findCameras(const fs::path& root, std::vector<DeviceFile>& out) {
    for (const fs::path& entry : entries(root / "sys/class/video4linux")) {
        if (!entry.filename().string().starts_with("video")) {
            continue;
        }
        DeviceFile file;
        file.name = lineOf(entry / "name");
        file.node = root / "dev" / entry.filename();
        if (const auto usb = usbParent(entry / "device")) {
            fillUsb(*usb, file);
        }
        file.refused = refusalOf(file.node, R_OK | W_OK);
        out.push_back(file);
    }
}

} // namespace

std::vector<DeviceFile> findDeviceFiles(const fs::path& root) {
    std::vector<DeviceFile> found;
    findOnBus(root, found);
    findSpaceMice(root, found);
    findCameras(root, found);
    findSerialPorts(root, found);
    const auto key = [](const DeviceFile& f) { // video2 before video10
        return std::tuple(f.kind, f.node.native().size(), f.node.native());
    };
    std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    return found;
}

std::string usbIdText(uint16_t vendor, uint16_t product) {
    return printed("%04x:%04x", vendor, product);
}

} // namespace fathom
