// SPDX-License-Identifier: Apache-2.0
// Packets that waited in a queue while their reader was held up.
#include "devices/bridge/socket_hand.h"
#include "devices/bridge/socket_server.h"
#include "tests/devices/socket_rig.h"

#include <atomic>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint64_t kMs = 1000000;

} // namespace

TEST_CASE("A wrench that is too old is not rendered, and a sample that is too old moves nothing") {
    SocketFolder folder;
    SocketServer server(serverAt(folder.endpoint()));
    DeviceSocket engine = DeviceSocket::connect(folder.endpoint());
    fathom_door_wrench packet = wrenchPacket(1, 2.0);
    for (uint64_t age = 300; age > 20; --age) { // an engine that pressed until 20 ms ago
        packet.header.time_ns = socketClock() - age * kMs;
        REQUIRE(engine.send(packet) == SocketEvent::Packet);
        server.poll();
    }
    CHECK(server.hasEngine());
    CHECK(server.wrench().force.x == 0.0);
    packet.header.time_ns = socketClock() + 1000 * kMs; // a stamp from the future counts as now
    engine.send(packet);
    server.poll();
    pauseMs(15);
    CHECK(server.wrench().force.x == 0.0);

    const auto other = folder.path() / "old.door";
    DeviceSocket endpoint = DeviceSocket::listen(other, 1);
    std::atomic<bool> made{false};
    std::thread bridge([&] {
        DeviceSocket bridged;
        CHECK(eventually([&] { return (bridged = endpoint.accept()).open(); }));
        fathom_door_hand sample = handPacket(1, 0.5);
        sample.header.time_ns -= 500 * kMs;
        bridged.send(sample);
        CHECK(eventually([&] { return made.load(); }));
    });
    {
        SocketHand hand(other, 4);
        CHECK(hand.read(0.0).buttons == 6);
        CHECK_FALSE(hand.alive());
        made = true;
    }
    bridge.join();
}
