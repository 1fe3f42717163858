// SPDX-License-Identifier: Apache-2.0
// The other end of a socket changes: an engine follows another one, a bridge returns with another device.
#include "devices/bridge/socket_hand.h"
#include "tests/devices/socket_rig.h"
#include "tests/realtime/listening.h"

#include <memory>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("An engine that connects before the bridge has seen the end of the last one is accepted") {
    SocketFolder folder;
    SocketServer server(serverAt(folder.endpoint()));
    DeviceSocket first = DeviceSocket::connect(folder.endpoint());
    server.poll();
    REQUIRE(server.hasEngine());
    CHECK(first.send(wrenchPacket(1, 1.0)) == SocketEvent::Packet);
    first.close();
    DeviceSocket second = DeviceSocket::connect(folder.endpoint());
    server.poll();
    REQUIRE(server.hasEngine());
    CHECK(server.wrench().force.x == 0.0); // not the force of the first one
    CHECK(second.send(wrenchPacket(1, 2.0)) == SocketEvent::Packet);
    server.poll();
    CHECK(server.wrench().force.x > 0.0); // rises
    DeviceSocket third = DeviceSocket::connect(folder.endpoint());
    server.poll();
    fathom_door_hand packet{};
    CHECK(third.receive(packet, FATHOM_DOOR_HAND) == SocketEvent::Closed);
    CHECK(server.hasEngine());
}

TEST_CASE("A bridge that returns with another device gives no force, and the log says so once") {
    SocketFolder folder;
    const Listening log;
    SocketServer::Options options = serverAt(folder.endpoint());
    auto server = std::make_unique<SocketServer>(options);
    HandSample sample;
    const auto tick = [&](SocketHand& hand) {
        server->poll();
        server->send(sample, FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED);
        hand.read(0.0);
        hand.write({{1.0, 0.0, 0.0}, {}}, 0.001);
        pauseMs(1);
    };
    std::unique_ptr<SocketHand> hand;
    std::thread opens([&] { hand = std::make_unique<SocketHand>(folder.endpoint(), 4, 20.0); });
    CHECK(eventually([&] {
        server->poll();
        server->send(sample, FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED);
        return server->hasEngine();
    }));
    opens.join();
    REQUIRE(eventually([&] {
        tick(*hand);
        return hand->alive();
    }));
    server.reset();
    options.preset = "omega";
    server = std::make_unique<SocketServer>(options);
    const std::string words = "the device is now a omega, not a falcon: no force until a restart";
    CHECK(eventually([&] {
        tick(*hand);
        return log.count(words) > 0;
    }));
    for (int i = 0; i < 300; ++i) {
        tick(*hand);
    }
    CHECK_FALSE(hand->alive());
    CHECK(server->wrench().force.x == 0.0);
    CHECK(log.count(words) == 1);
}
