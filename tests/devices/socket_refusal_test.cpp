// SPDX-License-Identifier: Apache-2.0
// What the engine says about a bridge that sends something else than it should.
#include "devices/bridge/socket_hand.h"
#include "tests/devices/socket_rig.h"
#include "tests/support/refusal.h"

#include <algorithm>
#include <cstring>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("The refusal of a bridge's first packet has one list of allowed values") {
    SocketFolder folder;
    DeviceSocket endpoint = DeviceSocket::listen(folder.endpoint(), 1);
    fathom_door_hand packet = handPacket(1, 0.0);
    std::string found;
    SUBCASE("version") {
        packet.header.version = 2;
        found = "version 2 (allowed: 1)";
    }
    SUBCASE("kind") {
        packet.header.kind = FATHOM_DOOR_WRENCH;
        found = "kind 2 (allowed: 1)";
    }
    SUBCASE("size") {
        packet.header.size = 80;
        found = "size 80 (allowed: 152)";
    }
    SUBCASE("magic") {
        packet.header.magic = 7;
        found = "not a valid packet (allowed: the structs of <fathom/device_socket.h>)";
    }
    DeviceSocket engine;
    std::thread bridge([&] {
        CHECK(eventually([&] { return (engine = endpoint.accept()).open(); }));
        CHECK(engine.send(packet) == SocketEvent::Packet);
    });
    const std::string refusal = refusalOf([&] { SocketHand(folder.endpoint(), 4); });
    bridge.join();
    CHECK(refusal == std::string("socket: ").append(folder.endpoint()).append(": ").append(found));
}

TEST_CASE("The name that a bridge sends cannot control a terminal or forge a line") {
    SocketFolder folder;
    DeviceSocket endpoint = DeviceSocket::listen(folder.endpoint(), 1);
    DeviceSocket engine;
    std::thread bridge([&] {
        fathom_door_hand packet = handPacket(1, 0.0);
        std::strcpy(packet.name, "\x1b[31m\n\xff hand");
        CHECK(eventually([&] { return (engine = endpoint.accept()).open(); }));
        CHECK(engine.send(packet) == SocketEvent::Packet);
    });
    const SocketHand hand(folder.endpoint(), 4);
    bridge.join();
    CHECK(hand.description() ==
          std::string(" [31m ? hand at ").append(folder.endpoint()).append(" (preset x)"));
}
