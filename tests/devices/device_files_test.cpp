// SPDX-License-Identifier: Apache-2.0
// Devices found in a made-up /sys and /dev.
#include "devices/usb/device_files.h"

#include "devices/usb/udev_rule.h"
#include "tests/devices/socket_rig.h"

#include <fstream>

#include <sys/stat.h>

using namespace fathom;
using namespace fathom::testing;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text << "\n";
}

struct Machine {
    fs::path usb(const std::string& place, const std::string& vendor, const std::string& product,
                 const std::string& name, int number) {
        const fs::path device = root() / "sys/devices/pci0/usb1" / place;
        write(device / "idVendor", vendor);
        write(device / "idProduct", product);
        write(device / "product", name);
        write(device / "busnum", "1");
        write(device / "devnum", std::to_string(number));
        fs::create_directories(root() / "sys/bus/usb/devices");
        fs::create_directory_symlink(device, root() / "sys/bus/usb/devices" / place);
        return device;
    }
    // An entry of /sys/class and its node.
    void node(const std::string& kind, const std::string& name, const fs::path& device,
              const std::string& title) {
        const fs::path entry = root() / "sys/class" / kind / name;
        fs::create_directories(device);
        fs::create_directories(entry);
        fs::create_directory_symlink(device, entry / "device");
        if (!title.empty()) {
            write(entry / "name", title);
        }
        write(root() / "dev" / name, "");
    }
    const fs::path& root() const { return folder.path(); }
    SocketFolder folder;
};

} // namespace

TEST_CASE("sysfs lists a Falcon, a SpaceMouse and cameras in order, and no other devices") {
    Machine m;
    m.usb("1-2", "0403", "cb48", "FALCON HAPTIC", 7);
    write(m.root() / "dev/bus/usb/001/007", "");
    m.usb("1-4", "0403", "6001", "a serial cable", 8);
    const fs::path mouse = m.usb("1-1.3", "256f", "c635", "SpaceMouse Compact", 9);
    m.node("hidraw", "hidraw2", mouse / "1-1.3:1.0/0003:256F:C635.0001", "");
    const fs::path keys = m.usb("1-5", "046d", "c31c", "a keyboard", 10);
    m.node("hidraw", "hidraw0", keys / "1-5:1.0/0003:046D:C31C.0002", "");
    const fs::path camera = m.usb("1-6", "8086", "0b07", "RealSense D435", 11);
    m.node("video4linux", "video10", camera / "1-6:1.0", "Intel RealSense");
    m.node("video4linux", "video2", m.root() / "sys/devices/virtual/vivid.0", "vivid-000-vid-cap");
    m.node("video4linux", "v4l-subdev0", camera / "1-6:1.1", "no video node");

    const auto found = findDeviceFiles(m.root());
    REQUIRE(found.size() == 4);
    CHECK(found[0].kind == DeviceFile::Kind::Falcon);
    CHECK(found[0].node == m.root() / "dev/bus/usb/001/007");
    CHECK(found[0].place == "usb 1-2");
    CHECK(found[1].kind == DeviceFile::Kind::SpaceMouse);
    CHECK(found[1].node == m.root() / "dev/hidraw2");
    CHECK(found[1].name == "SpaceMouse Compact");
    CHECK(usbIdText(found[1].vendor, found[1].product) == "256f:c635");
    CHECK(found[2].node == m.root() / "dev/video2");
    CHECK(found[2].name == "vivid-000-vid-cap");
    CHECK(found[2].vendor == 0);
    CHECK(found[3].node == m.root() / "dev/video10");
    CHECK(found[3].vendor == 0x8086);
    for (const auto& file : found) {
        CHECK(file.refused.empty());
    }
}

TEST_CASE("USB and on-board serial ports are listed, except those without a chip") {
    Machine m;
    const fs::path cable = m.usb("1-4", "0403", "6001", "FT232R USB UART", 8);
    m.node("tty", "ttyUSB0", cable / "1-4:1.0/ttyUSB0", "");
    const fs::path tty = m.root() / "sys/class/tty";
    write(tty / "ttyS0/type", "4");
    write(m.root() / "dev/ttyS0", "");
    write(tty / "ttyS1/type", "0");
    fs::create_directories(tty / "tty7");
    const auto found = findDeviceFiles(m.root());
    REQUIRE(found.size() == 2);
    CHECK(found[0].kind == DeviceFile::Kind::SerialPort);
    CHECK(found[0].node == m.root() / "dev/ttyS0");
    CHECK(found[0].name == "serial port");
    CHECK(found[1].node == m.root() / "dev/ttyUSB0");
    CHECK(found[1].name == "FT232R USB UART");
    CHECK(found[1].refused.empty());
}

TEST_CASE("Devices without a driver here are listed with the reason, and similar product numbers are not") {
    Machine m;
    m.usb("1-2", "1451", "0402", "", 7);
    m.usb("1-3", "1d27", "0601", "Xtion PRO LIVE", 8);
    write(m.root() / "dev/bus/usb/001/008", "");
    m.usb("1-4", "2bc5", "0670", "a camera of the kernel's", 9);
    m.usb("1-5", "1452", "0402", "", 10);
    const auto found = findDeviceFiles(m.root());
    REQUIRE(found.size() == 2);
    CHECK(found[0].kind == DeviceFile::Kind::OpenNi); // not the kernel's business, but OpenNI2's
    CHECK(found[0].name == "Xtion PRO LIVE");
    CHECK(found[0].node == m.root() / "dev/bus/usb/001/008");
    CHECK(found[0].refused.empty());
    CHECK(found[1].kind == DeviceFile::Kind::Closed);
    CHECK(found[1].name == "Force Dimension haptic device");
    CHECK(found[1].refused.find("devices/bridge/README.md") != std::string::npos);
}

TEST_CASE("A machine without devices lists none, and a missing node is reported") {
    Machine m;
    CHECK(findDeviceFiles(m.root()).empty());
    m.usb("1-2", "0403", "cb48", "FALCON HAPTIC", 7);
    const auto found = findDeviceFiles(m.root());
    REQUIRE(found.size() == 1);
    CHECK(found[0].refused == "No such file or directory");
}

TEST_CASE("A device without permission reports the udev rule, and the rule file lists every known device") {
    Machine m;
    m.usb("1-2", "0403", "cb48", "FALCON HAPTIC", 7);
    write(m.root() / "dev/bus/usb/001/007", "");
    fs::permissions(m.root() / "dev/bus/usb/001/007", fs::perms::owner_read);
    if (::geteuid() != 0) {
        CHECK(findDeviceFiles(m.root())[0].refused.find(kUdevRuleFile) != std::string::npos);
    } else {
        fs::permissions(m.root(), fs::perms(0755));
        Child other([&] {
            if (::setgid(65534) != 0 || ::setuid(65534) != 0) {
                return 98;
            }
            const auto found = findDeviceFiles(m.root());
            return found.size() == 1 && found[0].refused.find(kUdevRuleFile) != std::string::npos ? 1 : 0;
        });
        CHECK(other.wait() == 1);
    }
    std::ifstream in(kUdevRuleFile);
    const std::string rules{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    for (const char* id : {"cb48", "0403", "256f", "046d", "c603", "c626", "c62b", "1d27", "2bc5",
                           "video4linux", "ttyUSB", "uaccess"}) {
        CHECK_MESSAGE(rules.find(id) != std::string::npos, id);
    }
}
