// SPDX-License-Identifier: Apache-2.0
// Output of `fathom devices` for haptic devices, cameras and endpoints, on a fake /sys and /dev with real
// sockets.
#include "apps/devices/hand_devices.h"
#include "devices/bridge/socket_server.h"
#include "tests/support/sanitized.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <sstream>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

std::string printed(const fs::path& root, const fs::path& endpoints) {
    std::ostringstream out;
    printHandDevices(out, root, endpoints);
    return out.str();
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// Leaves a socket without its bridge.
void leaveSocket(const fs::path& file) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    file.string().copy(address.sun_path, sizeof address.sun_path - 1);
    const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
    REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    ::close(socket);
}

void usbDevice(const fs::path& root, const std::string& vendor, const std::string& product) {
    const fs::path device = root / "sys/bus/usb/devices/1-3";
    fs::create_directories(device);
    testing::put(device / "idVendor", vendor + "\n");
    testing::put(device / "idProduct", product + "\n");
    testing::put(device / "busnum", "1\n");
    testing::put(device / "devnum", "8\n");
    fs::create_directories(root / "dev/bus/usb/001");
    testing::put(root / "dev/bus/usb/001/008", "");
}

} // namespace

TEST_CASE(
    "An endpoint with a running bridge is listed, a stale endpoint is rejected, and a file is no endpoint") {
    const testing::ScratchFolder root, endpoints;
    CHECK(printed(root.path(), endpoints.path()) == "no camera, haptic device or bridge socket found\n");
    CHECK(printed(root.path(), "") == "no camera, haptic device or bridge socket found\n");
    testing::put(endpoints.path() / "file.door", "no socket");
    CHECK(printed(root.path(), endpoints.path()) == "no camera, haptic device or bridge socket found\n");
    const SocketServer server({endpoints.path() / "live.door", "falcon", "test device", 8.0, 0.2});
    leaveSocket(endpoints.path() / "gone.door");
    const std::string gone = (endpoints.path() / "gone.door").string(),
                      live = (endpoints.path() / "live.door").string();
    CHECK(printed(root.path(), endpoints.path()) ==
          "door    " + gone + "\n          REFUSED: its bridge has ended\n" + "door    " + live +
              "\n          a bridge listens; --hand-device " + live + "\n");
}

TEST_CASE("A camera that cannot be queried shows the reason, and endpoints are listed after devices") {
    const testing::ScratchFolder root, endpoints;
    fs::create_directories(root.path() / "sys/class/video4linux/video3");
    testing::put(root.path() / "sys/class/video4linux/video3/name", "a camera\n");
    fs::create_directories(root.path() / "dev");
    testing::put(root.path() / "dev/video3", "");
    leaveSocket(endpoints.path() / "gone.door");
    const std::string text = printed(root.path(), endpoints.path());
    CHECK(
        holds(text, "camera  " + (root.path() / "dev/video3").string() + "  a camera\n          REFUSED: "));
    CHECK(holds(text, "not a video device"));
    CHECK(text.find("door    ") > text.find("camera  "));
}

TEST_CASE("An OpenNI2 camera without a driver is listed with the reason") {
    if (kSanitized) { // OpenNI2 unloads drivers that still have allocations: leaks without a name
        return;
    }
    const testing::ScratchFolder root;
    usbDevice(root.path(), "1d27", "0601");
    const std::string text = printed(root.path(), "");
    CHECK(holds(text, "camera  "));
    CHECK(holds(text, "PrimeSense depth camera (Xtion, Carmine), 1d27:0601"));
    CHECK(holds(text, "REFUSED: openni2"));
}
