// SPDX-License-Identifier: Apache-2.0
// How an engine ends its force without closing the connection.
#include "devices/bridge/socket_server.h"
#include "tests/devices/socket_rig.h"

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("An engine's last wrench ends the force at once, although the connection stays open") {
    SocketFolder folder;
    SocketServer server(serverAt(folder.endpoint()));
    DeviceSocket engine = DeviceSocket::connect(folder.endpoint());
    const uint64_t now = socketClock();
    fathom_door_wrench packet = wrenchPacket(1, 2.0);
    for (uint64_t age = 150; age > 0; --age) { // the ramp of the gate, one wrench per millisecond
        packet.header.time_ns = now - age * 1000000;
        ++packet.header.sequence;
        REQUIRE(engine.send(packet) == SocketEvent::Packet);
        server.poll();
    }
    REQUIRE(server.gate().at(now).force.x == 2.0);
    packet.flags = FATHOM_DOOR_LAST;
    packet.header.time_ns = now;
    REQUIRE(engine.send(packet) == SocketEvent::Packet);
    server.poll();
    CHECK(server.hasEngine());
    CHECK(server.gate().at(now).force.x == 0.0);
}
