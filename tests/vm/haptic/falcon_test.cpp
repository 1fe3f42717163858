// SPDX-License-Identifier: Apache-2.0
// The Falcon's bridge on the kernel's own USB stack, with faults, and its socket to an engine.
#include "devices/bridge/socket_hand.h"
#include "devices/usb/falcon_bridge.h"
#include "devices/usb/falcon_kinematics.h"
#include "engine/types/error.h"
#include "tests/devices/socket_rig.h"
#include "tests/vm/haptic/falcon_device.h"
#include "tests/vm/vhci_port.h"

#include <fstream>
#include <glm/geometric.hpp>
#include <optional>

#include <fcntl.h>

using namespace fathom;
using namespace fathom::testing;
using fathom::vm::FalconDevice;

namespace {

using Motors = std::array<int16_t, 3>;
constexpr Motors kNoTorque{};
const dvec3 kKnob(0.01, -0.02, 0.12);

void placeAt(FalconDevice& device, const dvec3& knob) {
    device.setEncoders(FalconKinematics::encoderOf(*FalconKinematics::inverse(knob)));
}

// Retried, because the kernel needs time to enumerate.
std::unique_ptr<FalconBridge> openBridge(const FalconBridge::Options& options) {
    std::unique_ptr<FalconBridge> bridge;
    std::string fault;
    vm::waitFor([&] {
        try {
            bridge = std::make_unique<FalconBridge>(options);
        } catch (const BadInput& e) {
            fault = e.what();
        }
        return bridge != nullptr;
    });
    REQUIRE_MESSAGE(bridge, fault);
    return bridge;
}

struct Running { // the bridge on a thread of this process
    explicit Running(const FalconBridge::Options& options)
        : bridge(openBridge(options))
        , thread([this] { bridge->run(stop); }) {}
    ~Running() { end(); }
    void end() {
        stop = true;
        if (thread.joinable()) {
            thread.join();
        }
    }
    std::unique_ptr<FalconBridge> bridge;
    std::atomic<bool> stop{false};
    std::thread thread;
};

// One tick of an engine that pushes along z.
HandSample step(SocketHand& hand, double fz = 2.0) {
    const HandSample sample = hand.read(0.0);
    hand.write({{0.0, 0.0, fz}, {0.0, 0.1, 0.0}}, 0.001);
    pauseMs(1);
    return sample;
}

bool pushes(const FalconDevice& device) {
    const Motors m = device.motors();
    return m != kNoTorque && std::abs(m[0]) + std::abs(m[1]) + std::abs(m[2]) > 200;
}

// A Falcon on the bus and its bridge.
struct PluggedFalcon {
    explicit PluggedFalcon(bool homed = true) {
        placeAt(device, kKnob);
        device.homed = homed;
        device.plug();
        running.emplace(FalconBridge::Options{folder.endpoint(), {}});
    }

    SocketFolder folder;
    FalconDevice device;
    std::optional<Running> running;
};

std::string faultOf(const FalconBridge::Options& options) {
    std::string fault;
    vm::waitFor([&] { // "not found" means that it is not enumerated yet
        try {
            FalconBridge bridge(options);
            fault = "none";
        } catch (const Error& e) {
            fault = e.what();
        }
        return fault.find("not found") == std::string::npos;
    });
    return fault;
}

} // namespace

TEST_CASE(
    "The knob's position reaches the engine, the force reaches the motors, and at the end they are at zero") {
    PluggedFalcon falcon;
    FalconDevice& device = falcon.device;
    {
        SocketHand hand(falcon.folder.endpoint(), 4);
        CHECK(hand.preset() == "falcon");
        CHECK(eventually([&] { return glm::distance(step(hand).deviceThandle.position, kKnob) < 1e-4; }));
        CHECK(eventually([&] {
            step(hand);
            return pushes(device);
        }));
        const auto torques =
            FalconKinematics::torques(kKnob, *FalconKinematics::inverse(kKnob), {0.0, 0.0, 2.0});
        CHECK(eventually([&] { // the whole force, once it has risen
            step(hand);
            const Motors m = device.motors();
            return std::abs(m[0] + 10000.0 * (*torques)[0]) < 10.0 &&
                   std::abs(m[2] + 10000.0 * (*torques)[2]) < 10.0;
        }));
        const auto before = std::chrono::steady_clock::now();
        const uint64_t commands = device.commands, unasked = device.unasked;
        for (int i = 0; i < 1000; ++i) {
            step(hand);
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
        MESSAGE("exchanges " << static_cast<double>(device.commands - commands) / took.count()
                             << " Hz; worst age of a sample per tick " << hand.figures().worstAge * 1e3
                             << " ms");
        // Not every command meets a pending transfer: modem status may have used it at that moment.
        CHECK(device.commands > commands + 20);
        CHECK(device.unasked - unasked < (device.commands - commands) / 4);
        CHECK(eventually([&] {
            step(hand);
            return hand.alive() && pushes(device);
        }));
        falcon.running->end(); // like Ctrl-C, with the engine still pushing
        CHECK(device.motors() == kNoTorque);
        step(hand);
    }
    CHECK(falcon.running->bridge->figures().faults == 0);
}

TEST_CASE("The exchange survives half a packet, two at once, and a late, dropped or wrong answer") {
    PluggedFalcon falcon;
    FalconDevice& device = falcon.device;
    SocketHand hand(falcon.folder.endpoint(), 4);
    REQUIRE(eventually([&] { return step(hand).buttons == 0 && pushes(device); }));
    std::atomic<int>* fault = nullptr;
    SUBCASE("half a packet") {
        fault = &device.faults.half;
    }
    SUBCASE("two packets in one transfer") {
        fault = &device.faults.twofold;
    }
    SUBCASE("late by 15 ms") {
        fault = &device.faults.late;
    }
    SUBCASE("late by 45 ms, after the timeout") {
        device.faults.lateMs = 45;
        fault = &device.faults.late;
    }
    SUBCASE("modem status alone") {
        fault = &device.faults.dropped;
    }
    SUBCASE("a wrong character") {
        fault = &device.faults.wrong;
    }
    const bool inTime = fault == &device.faults.late && device.faults.lateMs < 45;
    const bool twofold = fault == &device.faults.twofold;
    *fault = 3;
    CHECK(eventually([&] {
        step(hand);
        return fault->load() == 0;
    }));
    const uint64_t commands = device.commands;
    const dvec3 next(-0.02, 0.01, 0.14);
    placeAt(device, next);
    CHECK(eventually([&] { return glm::distance(step(hand).deviceThandle.position, next) < 1e-4; }));
    CHECK(eventually([&] {
        step(hand);
        return hand.alive() && pushes(device);
    }));
    CHECK(device.commands > commands);
    falcon.running->end();
    CHECK(device.motors() == kNoTorque);
    const FalconFigures f = falcon.running->bridge->figures();
    CHECK((f.surplus >= 3 || !twofold));
    CHECK((f.late + f.faults + f.surplus > 0 || inTime));
    CHECK(f.faults <= 3);
}

TEST_CASE("A Falcon unplugged in mid-exchange opens the dead-man switch; plugged in again it resumes") {
    PluggedFalcon falcon;
    FalconDevice& device = falcon.device;
    SocketHand hand(falcon.folder.endpoint(), 4);
    REQUIRE(eventually([&] { return step(hand).buttons == 0 && pushes(device); }));
    device.unplug();
    CHECK(eventually([&] { return step(hand).buttons == 6; }));
    CHECK_FALSE(hand.alive());
    CHECK(glm::distance(step(hand).deviceThandle.position, kKnob) < 1e-4); // the last position, held
    device.homed = false;                                                  // lost with the power
    device.plug();
    const uint64_t commands = device.commands;
    CHECK(eventually([&] {
        step(hand);
        return device.commands > commands + 50;
    }));
    CHECK(step(hand).buttons == 6);
    CHECK(device.motors() == kNoTorque); // no position, no force
    device.homed = true;
    CHECK(eventually([&] { return step(hand).buttons == 0 && pushes(device); }));
    CHECK(falcon.running->bridge->losses() >= 1);
}

TEST_CASE("A Falcon that is not homed gives neither a position nor a force") {
    PluggedFalcon falcon(false);
    const FalconDevice& device = falcon.device;
    SocketHand hand(falcon.folder.endpoint(), 4);
    for (int i = 0; i < 300; ++i) {
        CHECK(step(hand).buttons == 6);
    }
    const auto history = device.history();
    CHECK(std::all_of(history.begin(), history.end(), [](const Motors& m) { return m == kNoTorque; }));
    CHECK(history.size() > 50);
}

TEST_CASE(
    "A device without firmware gets the user's file; without one, or with a wrong answer, it is rejected") {
    SocketFolder folder;
    const auto file = folder.path() / "firmware.bin";
    vm::Bytes blob;
    for (int i = 0; i < FalconDevice::kFirmwareSize; ++i) {
        blob.push_back(static_cast<uint8_t>(i * 7));
    }
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(blob.data()), std::ssize(blob));
    FalconDevice device(false);
    device.plug();
    const auto says = [](const std::string& fault, const std::string& part) {
        CHECK_MESSAGE(fault.find(part) != std::string::npos, fault);
    };
    SUBCASE("no file") {
        says(faultOf({folder.endpoint(), {}}), "after power-on it needs firmware: --firmware");
    }
    SUBCASE("a wrong echo") {
        device.wrongEchoAt = 200;
        says(faultOf({folder.endpoint(), file}), "echo at byte 186: answer");
    }
    SUBCASE("modem status alone") {
        FalconDevice other;
        device.unplug();
        other.statusOnly = true;
        other.plug();
        says(faultOf({folder.endpoint(), {}}), "no answer");
        CHECK(other.statusPackets > 5);
    }
    SUBCASE("well") {
        placeAt(device, kKnob);
        Running running({folder.endpoint(), file});
        CHECK(device.firmware() == blob);
        SocketHand hand(folder.endpoint(), 4);
        CHECK(eventually([&] { return step(hand).buttons == 0 && pushes(device); }));
    }
}

TEST_CASE("A Falcon without access permission is rejected with the name of the udev rule") {
    FalconDevice device;
    device.plug();
    SocketFolder folder;
    faultOf({folder.endpoint(), {}}); // until it is enumerated
    Child other([&] {
        if (::setgid(65534) != 0 || ::setuid(65534) != 0) {
            return 98;
        }
        try {
            UsbFtdi port("falcon", FalconBridge::kVendor, FalconBridge::kProduct);
        } catch (const BadInput& e) {
            const std::string text = e.what();
            return text.find("no permission") != std::string::npos &&
                           text.find("devices/70-fathom.rules") != std::string::npos
                       ? 1
                       : 97;
        }
        return 0;
    });
    CHECK(other.wait() == 1);
}
