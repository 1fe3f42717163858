// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_packet.h"

#include <doctest/doctest.h>
#include <string>

using namespace fathom;

namespace {

std::span<const uint8_t> bytesOf(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

// Encoders 1, -1, 4660 (0x1234); buttons 8, 4 and 1; all homed.
const std::string kReply = std::string("<BAAAPPPPEDCB") + static_cast<char>(0x41 + 0x7d) + "A>";

} // namespace

TEST_CASE("A motor command is sixteen characters, the least nibble first") {
    FalconCommand command;
    command.motor = {0x1234 & 4095, -1, -4096};
    command.green = true;
    const auto bytes = encodeFalcon(command);
    CHECK(std::string(bytes.begin(), bytes.end()) == "<EDCAPPPPAAAPDA>");
    command = {};
    command.homing = false;
    const auto rest = encodeFalcon(command);
    CHECK(std::string(rest.begin(), rest.end()) == "<AAAAAAAAAAAAAA>");
    command.homing = command.red = command.blue = command.green = true;
    CHECK(encodeFalcon(command)[13] == 0x41 + 15);
}

TEST_CASE("Every command value comes back from an encoder of the same value") {
    for (int value = -32768; value <= 32767; value += 97) {
        FalconCommand command;
        command.motor = {static_cast<int16_t>(value), static_cast<int16_t>(-value - 1), 7};
        const auto state = decodeFalcon(encodeFalcon(command)); // the layout is the same both ways
        REQUIRE(state);
        CHECK(state->encoder == command.motor);
    }
}

TEST_CASE("A reply gives encoders, buttons and which legs are homed") {
    FalconStream stream;
    stream.feed(bytesOf(kReply));
    REQUIRE(stream.packets() == 1);
    CHECK(stream.newest().encoder == std::array<int16_t, 3>{1, -1, 0x1234});
    CHECK(stream.newest().buttons == 13);
    CHECK(stream.newest().allHomed());
    CHECK(stream.faults() == 0);
}

TEST_CASE("A reply in halves, with noise before it, or two at once are all found") {
    for (size_t cut = 0; cut <= kReply.size(); ++cut) {
        FalconStream stream;
        stream.feed(bytesOf("AA>x"));
        stream.feed(bytesOf(kReply.substr(0, cut)));
        stream.feed({});
        stream.feed(bytesOf(kReply.substr(cut)));
        CHECK(stream.packets() == 1);
        CHECK(stream.faults() == 0);
    }
    FalconStream stream;
    stream.feed(bytesOf(kReply + "<CAAAAAAAAAAAAA>"));
    CHECK(stream.packets() == 2);
    CHECK(stream.newest().encoder[0] == 2);
    CHECK_FALSE(stream.newest().allHomed());
}

TEST_CASE("A truncated reply or one with a wrong character is skipped and counted") {
    FalconStream stream;
    stream.feed(bytesOf(kReply.substr(0, 9) + kReply));
    CHECK(stream.packets() == 1);
    CHECK(stream.faults() == 1);
    CHECK(stream.newest().encoder[2] == 0x1234);
    for (const size_t at : {1u, 5u, 12u, 13u, 15u}) {
        std::string wrong = kReply;
        wrong[at] = '@'; // just below 'A'
        stream.feed(bytesOf(wrong));
    }
    std::string wide = kReply;
    wide[3] = 'Q'; // just above 'A' + 15
    stream.feed(bytesOf(wide));
    CHECK(stream.packets() == 1);
    CHECK(stream.faults() == 7);
    stream.feed(bytesOf(kReply));
    CHECK(stream.packets() == 2);
}
