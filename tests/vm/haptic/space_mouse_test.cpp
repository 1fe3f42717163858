// SPDX-License-Identifier: Apache-2.0
// A SpaceMouse on the kernel's own USB and HID stack.
#include "apps/devices/hand_devices.h"
#include "devices/usb/device_files.h"
#include "devices/usb/space_mouse_hand.h"
#include "engine/types/error.h"
#include "tests/devices/socket_rig.h"
#include "tests/vm/haptic/falcon_device.h"
#include "tests/vm/haptic/space_mouse_device.h"

#include <chrono>
#include <sstream>

using namespace fathom;
using namespace fathom::testing;
using fathom::vm::SpaceMouseDevice;

namespace {

struct Cap {
    explicit Cap(bool combined = false)
        : device(combined) {
        device.plug();
        REQUIRE(eventually([&] {
            try {
                hand = std::make_unique<SpaceMouseHand>(std::filesystem::path());
            } catch (const BadInput&) { // not enumerated yet
            }
            return hand != nullptr;
        }));
    }
    HandSample read() {
        pauseMs(1);
        return hand->read(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    }
    std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
    SpaceMouseDevice device;
    std::unique_ptr<SpaceMouseHand> hand;
};

} // namespace

TEST_CASE("A SpaceMouse moves the hand on all axes while it is pushed, and holds it when released") {
    bool combined = false;
    SUBCASE("translation and rotation in two reports") {}
    SUBCASE("both in one report of twelve bytes, like later models") {
        combined = true;
    }
    Cap cap(combined);
    cap.read();
    cap.device.deflect({350, 0, -350}, {0, 350, 0});
    CHECK(eventually([&] { return cap.read().deviceThandle.position.x > 0.01; }));
    Pose pose = cap.read().deviceThandle;
    CHECK(pose.position.z > 0.005); // up
    CHECK(pose.position.y == 0.0);
    CHECK(rotationLog(pose.rotation).y < -0.05);
    cap.device.deflect({0, 0, 0}, {0, 0, 0});
    CHECK(eventually([&] {
        const Pose before = cap.read().deviceThandle;
        pauseMs(30);
        return cap.read().deviceThandle.position == before.position;
    }));
    cap.device.press(1);
    CHECK(eventually([&] { return cap.read().buttons == 1; }));
    cap.device.press(0);
    CHECK(eventually([&] { return cap.read().buttons == 0; }));
}

TEST_CASE("Truncated reports move nothing, and silence while pushed counts as released") {
    Cap cap;
    cap.read();
    cap.device.halves = true;
    cap.device.deflect({350, 350, 350}, {0, 0, 0});
    for (int i = 0; i < 100; ++i) {
        CHECK(cap.read().deviceThandle.position == dvec3(0.0));
    }
    cap.device.halves = false;
    CHECK(eventually([&] { return cap.read().deviceThandle.position.x > 0.002; }));
    cap.device.silent = true;
    CHECK(eventually([&] {
        const Pose before = cap.read().deviceThandle;
        pauseMs(150);
        return cap.read().deviceThandle.position == before.position;
    }));
}

TEST_CASE("A SpaceMouse unplugged while pushed opens the dead-man switch and stops; plugged in it resumes") {
    Cap cap;
    cap.device.deflect({350, 0, 0}, {0, 0, 0});
    CHECK(eventually([&] { return cap.read().deviceThandle.position.x > 0.002; }));
    cap.device.unplug();
    CHECK(eventually([&] { return cap.read().buttons == 6; }));
    const Pose before = cap.read().deviceThandle;
    CHECK(cap.read().deviceThandle.position == before.position);
    cap.device.deflect({0, 0, 0}, {0, 0, 0});
    cap.device.plug();
    CHECK(eventually([&] { return cap.read().buttons == 0 && cap.hand->alive(); }));
    cap.device.deflect({350, 0, 0}, {0, 0, 0});
    CHECK(eventually([&] { return cap.read().deviceThandle.position.x > before.position.x + 0.002; }));
}

TEST_CASE(
    "The list of devices shows Falcon and SpaceMouse with capabilities, and the reason without permission") {
    Cap cap;
    vm::FalconDevice falcon;
    falcon.plug();
    REQUIRE(eventually([] {
        const auto files = findDeviceFiles(); // the machine's serial ports are among them
        return files.size() >= 2 && files[0].kind == DeviceFile::Kind::Falcon &&
               files[1].kind == DeviceFile::Kind::SpaceMouse;
    }));
    std::ostringstream out;
    printHandDevices(out, "/", "/none");
    const std::string text = out.str();
    for (const char* part : {"FALCON HAPTIC, 0403:cb48 at usb", "x y z driven; torque is shown, not felt",
                             "SpaceNavigator, 046d:c626", "force and torque are shown, not felt",
                             "--hand-device spacemouse:/dev/hidraw"}) {
        CHECK_MESSAGE(text.find(part) != std::string::npos, text);
    }
    Child other([&] {
        if (::setgid(65534) != 0 || ::setuid(65534) != 0) {
            return 98;
        }
        int refused = 0;
        for (const DeviceFile& file : findDeviceFiles()) {
            const bool serial = file.kind == DeviceFile::Kind::SerialPort;
            refused += !serial && file.refused.find("devices/70-fathom.rules") != std::string::npos ? 1 : 0;
        }
        return refused;
    });
    CHECK(other.wait() == 2);
}
