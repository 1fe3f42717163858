// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/haply_message.h"
#include "devices/haply/web_socket.h"
#include "engine/types/error.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>

using namespace fathom;
using Event = WebSocketFrames::Event;

namespace {

// All events of these bytes, one byte at a time.
std::string eventsOf(std::string_view bytes) {
    WebSocketFrames frames;
    std::string all, text;
    for (const char byte : bytes) {
        frames.add({&byte, 1});
        for (Event e = frames.next(text); e != Event::None; e = frames.next(text)) {
            all += e == Event::Text     ? "[" + text + "]"
                   : e == Event::Ping   ? "ping " + text
                   : e == Event::Closed ? "closed"
                                        : "fault";
            if (e == Event::Fault) {
                return all;
            }
        }
    }
    return all;
}

std::string bytes(std::initializer_list<int> values) {
    std::string out;
    for (const int value : values) {
        out += static_cast<char>(value);
    }
    return out;
}

} // namespace

TEST_CASE("The published example frames are parsed: complete, fragmented and with pings in between") {
    CHECK(eventsOf(bytes({0x81, 5, 'H', 'e', 'l', 'l', 'o'})) == "[Hello]"); // RFC 6455, 5.7
    CHECK(eventsOf(bytes({0x01, 3, 'H', 'e', 'l', 0x80, 2, 'l', 'o'})) == "[Hello]");
    CHECK(eventsOf(bytes({0x01, 3, 'H', 'e', 'l', 0x89, 1, '?', 0x80, 2, 'l', 'o'})) == "ping ?[Hello]");
    CHECK(eventsOf(bytes({0x8a, 1, '?', 0x81, 0})) == "[]"); // a pong is nothing
    CHECK(eventsOf(bytes({0x88, 2, 3, 0xe8})) == "closed");
    for (const size_t size : {125u, 126u, 300u, 65535u, 65536u, 100000u}) {
        const std::string text(size, 'x');
        const std::string sent = webSocketFrame(1, text, 0);
        std::string plain = sent; // a server's: without mask
        const size_t head = size < 126 ? 2 : size < 65536 ? 4 : 10;
        plain[1] = static_cast<char>(plain[1] & 127);
        plain.erase(head, 4);
        CHECK(eventsOf(plain) == "[" + text + "]");
    }
}

TEST_CASE("What a client sends is masked as the published example is") {
    const std::string sent = webSocketFrame(1, "Hello", 0x3d21fa37);
    CHECK(sent == bytes({0x81, 0x85, 0x37, 0xfa, 0x21, 0x3d, 0x7f, 0x9f, 0x4d, 0x51, 0x58}));
}

TEST_CASE("Frames against the protocol are faults: masked, reserved bits, binary, out of order, too long") {
    CHECK(eventsOf(bytes({0x81, 0x85, 1, 2, 3, 4, 5, 6, 7, 8, 9})) == "fault");
    CHECK(eventsOf(bytes({0xc1, 1, 'x'})) == "fault");
    CHECK(eventsOf(bytes({0x82, 1, 'x'})) == "fault");
    CHECK(eventsOf(bytes({0x80, 1, 'x'})) == "fault");
    CHECK(eventsOf(bytes({0x01, 1, 'x', 0x81, 1, 'y'})) == "fault");
    CHECK(eventsOf(bytes({0x81, 127, 0, 0, 0, 1, 0, 0, 0, 0})) == "fault");
    CHECK(eventsOf(bytes({0x81, 127, 255, 255, 255, 255, 255, 255, 255, 255})) == "fault");
    const std::string most = bytes({0x01, 127, 0, 0, 0, 0, 0, 8, 0, 0}) + std::string(1 << 19, 'x');
    CHECK(eventsOf(most + bytes({0x80, 127, 0, 0, 0, 0, 0, 8, 0, 1}) + std::string((1 << 19) + 1, 'x')) ==
          "fault"); // in two, each short enough
}

TEST_CASE("A state of Haply's service is parsed, and an invalid one is rejected with what is missing") {
    const auto state = readHaplyState(
        R"({"inverse3": [{"device_id": "1", "state": {"cursor_position": {"x": 1, "y": 2, "z": 3}}},
                         {"device_id": "2", "state": {"cursor_position": {"x": 4, "y": 5, "z": 6}}}]})",
        "2");
    REQUIRE(state);
    CHECK(state->device == "2");
    CHECK(state->sample.deviceThandle.position == dvec3(4.0, 5.0, 6.0));
    CHECK_FALSE(state->grip);
    for (const char* none : {"{}", R"({"inverse3": 3})", R"({"inverse3": []})", R"({"inverse3": [7]})",
                             R"({"inverse3": [{"device_id": 7, "state": {}}]})",
                             R"({"inverse3": [{"device_id": "", "state": {}}]})"}) {
        CHECK_FALSE(readHaplyState(none, ""));
    }
    const auto fault = [](const char* text) {
        return testing::refusalOf<Error>([&] { readHaplyState(text, ""); });
    };
    CHECK(fault("nonsense").find("not a JSON object") != std::string::npos);
    CHECK(fault("[1]").find("not a JSON object") != std::string::npos);
    CHECK(fault(R"({"inverse3": [{"device_id": "1", "state": {}}]})").find("no cursor_position") !=
          std::string::npos);
    CHECK(
        fault(
            R"({"inverse3": [{"device_id": "1", "state": {"cursor_position": {"x": 1, "y": "2", "z": 3}}}]})")
            .find("lacks the number 'y'") != std::string::npos);
    CHECK(fault(R"({"inverse3": [{"device_id": "1", "state": {"cursor_position": {"x": 1, "y": 2, "z": 3}}}],
                    "verse_grip": [{"device_id": "3", "state": {"orientation": {"w": 0, "x": 0, "y": 0, "z": 0}}}]})")
              .find("zero orientation") != std::string::npos);
}
