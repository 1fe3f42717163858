// SPDX-License-Identifier: Apache-2.0
// `fathom guard falcon` as a process between a simulated Falcon and an engine that is killed.
#include "devices/bridge/socket_hand.h"
#include "devices/usb/device_files.h"
#include "devices/usb/falcon_kinematics.h"
#include "engine/types/error.h"
#include "tests/devices/socket_rig.h"
#include "tests/vm/haptic/falcon_device.h"

#include <cstdlib>

using namespace fathom;
using namespace fathom::testing;
using fathom::vm::FalconDevice;

namespace {

using Motors = std::array<int16_t, 3>;
constexpr Motors kStill{};
// 10 ms of silence, plus time for an emulated processor and a packet in flight.
constexpr double kLongestForce = 0.2; // [s]

// An engine that presses forever, once the socket exists.
int press(const std::filesystem::path& endpoint) {
    for (;;) {
        try {
            SocketHand hand(endpoint, 4);
            for (;;) {
                hand.read(0.0);
                hand.write({{1.0, 2.0, 3.0}, {}}, 0.001);
                pauseMs(1);
            }
        } catch (const BadInput&) {
            pauseMs(20);
        }
    }
}

struct Stage {
    Stage()
        : engine([this] { return press(folder.endpoint()); }) { // before any thread starts
        device.setEncoders(FalconKinematics::encoderOf(*FalconKinematics::inverse({0.0, 0.01, 0.13})));
        device.plug();
        REQUIRE(eventually([] { // the kernel enumerates
            const auto files = findDeviceFiles();
            return !files.empty() && files[0].kind == DeviceFile::Kind::Falcon && files[0].refused.empty();
        }));
        bridge = std::make_unique<Child>([this] {
            std::signal(SIGHUP, SIG_DFL); // the parent process may ignore it
            const std::string path = folder.endpoint().string();
            return ::execl(FATHOM_PROGRAM, "fathom", "guard", "falcon", "--door", path.c_str(), nullptr);
        });
        REQUIRE(eventually([&] { return device.motors() != kStill; }));
    }
    // Time [s] from a fault until the last command with a force; none may follow within 50 ms.
    double forceLasts(std::chrono::steady_clock::time_point fault) const {
        CHECK(eventually([&] { return device.motors() == kStill; }));
        pauseMs(50);
        CHECK(device.motors() == kStill);
        return std::chrono::duration<double>(device.released() - fault).count();
    }

    SocketFolder folder;
    Child engine;
    FalconDevice device;
    std::unique_ptr<Child> bridge;
};

} // namespace

TEST_CASE("An engine killed by SIGKILL leaves a Falcon without force, and the next one finds it") {
    Stage stage;
    const auto killed = std::chrono::steady_clock::now();
    stage.engine.signal(SIGKILL);
    const double lasted = stage.forceLasts(killed);
    MESSAGE("zero at the device " << 1e3 * lasted << " ms after the engine was killed");
    CHECK(lasted < kLongestForce);
    CHECK(stage.engine.wait() == -SIGKILL);
    const uint64_t commands = stage.device.commands;
    CHECK(eventually([&] { return stage.device.commands > commands + 20; })); // and it stays zero
    CHECK(stage.device.motors() == kStill);
    SocketHand next(stage.folder.endpoint(), 4);
    CHECK(eventually([&] {
        next.read(0.0);
        next.write({{0.0, 0.0, 2.0}, {}}, 0.001);
        pauseMs(1);
        return next.alive() && stage.device.motors() != kStill;
    }));
}

TEST_CASE("An engine that hangs loses its force within 0.2 s, although its socket stays open") {
    Stage stage;
    const auto stopped = std::chrono::steady_clock::now();
    stage.engine.signal(SIGSTOP);
    const double lasted = stage.forceLasts(stopped);
    MESSAGE("zero at the device " << 1e3 * lasted << " ms after the engine was stopped");
    CHECK(lasted < kLongestForce);
    stage.engine.signal(SIGCONT);
    CHECK(eventually([&] { return stage.device.motors() != kStill; }));
}

TEST_CASE("Ctrl-C at the bridge while an engine presses leaves zero force and exit code 0, as does closing "
          "the terminal") {
    int ending = SIGINT;
    SUBCASE("Ctrl-C") {}
    SUBCASE("the terminal is closed") {
        ending = SIGHUP;
    }
    SUBCASE("Ctrl-backslash") {
        ending = SIGQUIT;
    }
    Stage stage;
    const auto asked = std::chrono::steady_clock::now();
    stage.bridge->signal(ending);
    CHECK(stage.bridge->wait() == 0);
    CHECK(stage.forceLasts(asked) < kLongestForce);
    CHECK_FALSE(std::filesystem::exists(stage.folder.endpoint()));
}

TEST_CASE("A bridge whose log is no longer read continues") {
    Stage stage;
    stage.bridge->signal(SIGPIPE);
    const uint64_t commands = stage.device.commands;
    CHECK(eventually([&] { return stage.device.commands > commands + 20; }));
    CHECK(stage.device.motors() != kStill);
    stage.bridge->signal(SIGTERM);
    CHECK(stage.bridge->wait() == 0);
    CHECK(stage.device.motors() == kStill);
}

// Not a guarantee: it shows the state of the simulated device. A real one is unknown.
TEST_CASE("A bridge killed by SIGKILL sends nothing more to the device") {
    Stage stage;
    stage.bridge->signal(SIGKILL);
    CHECK(stage.bridge->wait() == -SIGKILL);
    pauseMs(50);
    const uint64_t commands = stage.device.commands;
    pauseMs(100);
    CHECK(stage.device.commands == commands);
    MESSAGE("what a real Falcon does then is not known; the last command was "
            << std::string(stage.device.motors() == kStill ? "zero" : "a force"));
}
