// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_firmware.h"
#include "devices/usb/falcon_link.h"
#include "tests/devices/fake_falcon.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <fstream>
#include <thread>

using namespace fathom;
using namespace fathom::testing;

namespace {

using std::chrono::milliseconds;

std::vector<uint8_t> blob(size_t size) {
    std::vector<uint8_t> bytes(size);
    for (size_t i = 0; i < size; ++i) {
        bytes[i] = static_cast<uint8_t>(i * 131 + 7);
    }
    return bytes;
}

std::string startFault(FakeFalcon& device, const std::vector<uint8_t>& firmware) {
    return refusalOf<Error>([&] { FalconLink(device).start(firmware); });
}

} // namespace

TEST_CASE("A running Falcon is used as it is: its port is configured and no firmware is loaded") {
    FakeFalcon device(true);
    FalconLink link(device);
    link.start(blob(100));
    CHECK(device.firmware.empty());
    CHECK(link.state().encoder == std::array<int16_t, 3>{10, 20, 30});
    CHECK(device.requests == std::vector<std::string>{"9=1", "3=2", "4=8", "0=1", "0=2"});
    for (const auto& motor : device.motors) {
        CHECK(motor == std::array<int16_t, 3>{});
    }
}

TEST_CASE("After power-on the whole firmware is loaded in echoed chunks, and then the device answers") {
    for (const size_t size : {1u, 62u, 63u, 1000u}) {
        FakeFalcon device(false);
        device.runsAfter = size;
        if (size == 63) {
            device.greeting.erase(0, 1); // the leading zero may be missing
        }
        FalconLink link(device);
        link.start(blob(size));
        CHECK(device.firmware == blob(size));
        CHECK(link.state().allHomed());
    }
}

TEST_CASE("A wrong answer during the firmware load stops it and reports the step and the answer") {
    FakeFalcon device(false);
    device.runsAfter = 200;
    std::string expected;
    std::vector<uint8_t> firmware = blob(200);
    SUBCASE("no firmware named") {
        firmware.clear();
        expected = "after power-on it needs firmware: --firmware FILE";
    }
    SUBCASE("no greeting") {
        device.greeting.clear();
        expected = "handshake: answer nothing (allowed: 0a 44 2c 0d)";
    }
    SUBCASE("wrong greeting") {
        device.greeting = "\n\x45,\r";
        expected = "handshake: answer 0a 45 2c 0d (allowed: 0a 44 2c 0d); switch";
    }
    SUBCASE("wrong answer to the speed change") {
        device.wrongSpeedAnswer = true;
        expected = "speed change: answer 3f (allowed: 41)";
    }
    SUBCASE("wrong echo") {
        device.wrongEchoAt = 130;
        expected = "echo at byte 124: answer";
    }
    SUBCASE("firmware that does not run") {
        device.runsAfter = SIZE_MAX;
        device.diesAfter = 200;
        expected = "no answer after loading the firmware";
    }
    const std::string fault = startFault(device, firmware);
    CHECK_MESSAGE(fault.find(expected) != std::string::npos, fault);
}

TEST_CASE("A firmware file that is missing, empty or too long is rejected") {
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "firmware.bin";
    CHECK_THROWS_AS(readFalconFirmware(file), BadInput);
    std::ofstream(file) << "";
    CHECK_THROWS_AS(readFalconFirmware(file), BadInput);
    std::ofstream(file) << std::string(65536, 'x');
    CHECK(readFalconFirmware(file).size() == 65536);
    std::ofstream(file) << std::string(65537, 'x');
    CHECK_THROWS_AS(readFalconFirmware(file), BadInput);
}

TEST_CASE("Only one command is in flight, and partial or duplicate answers do not stop the exchange") {
    FakeFalcon device(true);
    FalconLink link(device);
    link.start({});
    FalconCommand command;
    command.motor = {100, -200, 300};
    SUBCASE("whole") {}
    SUBCASE("seven bytes at a time") {
        device.most = 7;
    }
    SUBCASE("two in one transfer") {
        device.copies = 2;
    }
    int states = 0;
    for (int i = 0; i < 300; ++i) {
        device.state.encoder[0] = static_cast<int16_t>(i);
        states += link.exchange(command, milliseconds(0)) ? 1 : 0;
    }
    CHECK(states >= 100);
    CHECK(device.motors.back() == command.motor);
    CHECK(link.figures().faults == 0);
    CHECK(link.figures().late == 0);
    CHECK(link.figures().surplus == (device.copies == 2 ? link.figures().sent - 1 : 0));
    CHECK(link.state().encoder[0] > 290);
}

TEST_CASE("A missing answer expires after 20 ms, and a late one is used") {
    FakeFalcon device(true);
    FalconLink link(device);
    link.start({});
    device.most = 0; // answers are held back
    const uint64_t sent = link.figures().sent;
    CHECK_FALSE(link.exchange({}, milliseconds(0)));
    std::this_thread::sleep_for(milliseconds(5));
    CHECK_FALSE(link.exchange({}, milliseconds(0)));
    CHECK(link.figures().sent == sent + 1); // it waits
    std::this_thread::sleep_for(milliseconds(20));
    CHECK_FALSE(link.exchange({}, milliseconds(0)));
    CHECK(link.figures().late == 1);
    device.state.encoder[2] = 77;
    CHECK_FALSE(link.exchange({}, milliseconds(0)));
    CHECK(link.figures().sent == sent + 2);
    device.most = SIZE_MAX; // both at once
    CHECK(link.exchange({}, milliseconds(0)));
    CHECK(link.state().encoder[2] == 77);
    CHECK(link.figures().surplus == 1);
}

TEST_CASE("A device that is silent for half a second or unplugged is lost; stopping it never throws") {
    FakeFalcon device(true);
    FalconLink link(device);
    link.start({});
    FalconCommand command;
    command.motor = {4096, 0, 0};
    link.exchange(command, milliseconds(0));
    SUBCASE("unplugged") {
        device.unplugged = true;
        CHECK_THROWS_AS(link.exchange(command, milliseconds(0)), DeviceLost);
        link.stop();
    }
    SUBCASE("mute") {
        device.mute = true;
        CHECK_THROWS_AS(
            [&] {
                for (int i = 0; i < 300; ++i) {
                    link.exchange(command, milliseconds(0));
                    std::this_thread::sleep_for(milliseconds(5));
                }
            }(),
            DeviceLost);
        link.stop();
        CHECK(device.motors.back() == std::array<int16_t, 3>{});
    }
    SUBCASE("well") {
        CHECK(device.motors.back() == command.motor);
        link.stop();
        CHECK(device.motors.back() == std::array<int16_t, 3>{});
    }
}
