// SPDX-License-Identifier: Apache-2.0
// What the engine says about a bridge that sends something else than it should.
#include "devices/bridge/socket_hand.h"
#include "tests/devices/socket_rig.h"
#include "tests/realtime/listening.h"
#include "tests/support/refusal.h"

#include <algorithm>
#include <cstring>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A bridge with one engine. Its samples are right but for what the test changes.
struct WrongBridge {
    explicit WrongBridge(const SocketFolder& folder)
        : endpoint(DeviceSocket::listen(folder.endpoint(), 1))
        , thread([this] {
            uint64_t sequence = 0;
            for (; !stop.load(); pauseMs(1)) {
                DeviceSocket next = endpoint.accept();
                engine = next.open() ? std::move(next) : std::move(engine);
                fathom_door_hand packet = handPacket(++sequence, 0.0);
                packet.orientation[0] = length.load();
                packet.header.time_ns -= behind.load();
                packet.header.size += extra.load();
                packet.status &= homed.load() ? ~0u : ~static_cast<uint32_t>(FATHOM_DOOR_HOMED);
                engine.send(packet);
            }
        }) {}
    WrongBridge(const WrongBridge&) = delete;
    WrongBridge& operator=(const WrongBridge&) = delete;
    ~WrongBridge() {
        stop.store(true);
        thread.join();
    }
    std::atomic<double> length{1.0};
    std::atomic<uint64_t> behind{0}; // [ns]
    std::atomic<uint32_t> extra{0};
    std::atomic<bool> homed{true}, stop{false};
    DeviceSocket endpoint, engine;
    std::thread thread;
};

} // namespace

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
    const std::string refusal = refusalOf([&] { SocketHand(folder.endpoint(), 4, 60.0); });
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
    const SocketHand hand(folder.endpoint(), 4, 60.0);
    bridge.join();
    CHECK(hand.description() ==
          std::string(" [31m ? hand at ").append(folder.endpoint()).append(" (preset x)"));
}

TEST_CASE("The log says once why the samples of a bridge are refused, and they count again when they are "
          "right") {
    SocketFolder folder;
    const Listening log;
    WrongBridge bridge(folder);
    SocketHand hand(folder.endpoint(), 4, 60.0);
    const auto alive = [&] {
        hand.read(0.0);
        return hand.alive();
    };
    REQUIRE(eventually(alive));
    std::string words;
    SUBCASE("orientation of zeros") {
        bridge.length.store(0.0);
        words = "samples refused: orientation 0 0 0 0 (allowed: a quaternion w x y z of length 1; ";
    }
    SUBCASE("orientation of length 2") {
        bridge.length.store(2.0);
        words = "samples refused: orientation 2 0 0 0 (allowed: ";
    }
    SUBCASE("another clock") {
        bridge.behind.store(2000000000);
        words = " s behind CLOCK_MONOTONIC (allowed: at most 0.01 s)";
    }
    SUBCASE("another clock, of a device that homes later") {
        bridge.homed.store(false);
        bridge.behind.store(2000000000);
        for (int i = 0; i < 200; ++i, pauseMs(2)) {
            hand.read(0.0);
        }
        bridge.homed.store(true);
        words = " s behind CLOCK_MONOTONIC (allowed: at most 0.01 s)";
    }
    SUBCASE("size") {
        bridge.extra.store(1);
        words = "connection ended: size 153 (allowed: 152)";
    }
    CHECK(eventually([&] { return !alive() && log.count(words) > 0; }));
    for (int i = 0; i < 300; ++i, pauseMs(1)) {
        CHECK_FALSE(alive());
    }
    CHECK(log.count(words) == 1);
    bridge.length.store(1.0);
    bridge.behind.store(0);
    bridge.extra.store(0);
    CHECK(eventually(alive));
}

TEST_CASE("Samples that were late because the engine paused are not reported as refused") {
    SocketFolder folder;
    const Listening log;
    WrongBridge bridge(folder);
    SocketHand hand(folder.endpoint(), 4, 60.0);
    for (int i = 0; i < 3; ++i) {
        CHECK(eventually([&] {
            hand.read(0.0);
            return hand.alive();
        }));
        pauseMs(300); // the queue is full of old samples
    }
    CHECK(log.count("refused") == 0);
}
