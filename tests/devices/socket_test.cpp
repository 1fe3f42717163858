// SPDX-License-Identifier: Apache-2.0
// Both ends of the socket against each other and against invalid packets, in one process.
#include "devices/bridge/socket_hand.h"
#include "devices/bridge/socket_server.h"
#include "tests/devices/socket_rig.h"
#include "tests/support/refusal.h"

#include <cstring>
#include <fstream>
#include <vector>

#include <sys/socket.h>
#include <sys/stat.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr dquat kTurned(0.5, -0.1, 0.7, 0.5); // of unit length
constexpr uint32_t kReady = FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED;

bool has(const std::string& text, const std::string& part) {
    const bool found = text.find(part) != std::string::npos;
    if (!found) {
        MESSAGE("'" << part << "' is not in '" << text << "'");
    }
    return found;
}

// A server that answers while a SocketHand is made and used on this thread.
struct Talk {
    explicit Talk(const std::filesystem::path& endpoint)
        : server(serverAt(endpoint))
        , thread([this] {
            while (!stop.load()) {
                server.poll();
                HandSample sample;
                sample.deviceThandle = {{0.01 * level.load(), 0.02, 0.03}, kTurned};
                sample.buttons = 1;
                if (!mute.load()) {
                    server.send(sample, status.load());
                }
                felt.store(server.wrench().force.x);
                engine.store(server.hasEngine());
                pauseMs(1);
            }
        }) {}
    ~Talk() { end(); }
    void end() { // the server may be looked at from here on
        stop.store(true);
        if (thread.joinable()) {
            thread.join();
        }
    }
    SocketServer server;
    std::atomic<double> level{1.0}, felt{0.0};
    std::atomic<uint32_t> status{kReady};
    std::atomic<bool> stop{false}, mute{false}, engine{false};
    std::thread thread;
};

void tick(SocketHand& hand, double fx) {
    hand.read(0.0);
    hand.write({{fx, 0.0, 0.0}, {}}, 0.001);
    pauseMs(1);
}

} // namespace

TEST_CASE("Samples reach the engine, wrenches reach the device, and the last wrench is zero") {
    SocketFolder folder;
    Talk bridge(folder.endpoint());
    {
        SocketHand hand(folder.endpoint(), 4);
        CHECK(hand.preset() == "falcon");
        CHECK(has(hand.description(), "test device"));
        CHECK(eventually([&] { // forces rise over 0.1 s from the first wrench
            tick(hand, 2.0);
            return bridge.felt.load() == 2.0;
        }));
        bridge.level.store(7.0);
        CHECK(eventually([&] {
            tick(hand, 2.0);
            const HandSample sample = hand.read(0.0);
            return sample.deviceThandle.position == dvec3(0.01 * 7.0, 0.02, 0.03) && sample.buttons == 1;
        }));
        CHECK(std::abs(glm::dot(hand.read(0.0).deviceThandle.rotation, kTurned)) > 1.0 - 1e-12);
        CHECK(hand.alive());
        CHECK(eventually([&] {
            tick(hand, 2.0);
            return hand.figures().samples > 10;
        }));
    }
    CHECK(eventually([&] { return bridge.felt.load() == 0.0 && !bridge.engine.load(); }));
    bridge.end();
    CHECK(bridge.server.dropped() == 0);
}

TEST_CASE("A silent engine leaves zero force at the device, and its force returns when it is back") {
    SocketFolder folder;
    Talk bridge(folder.endpoint());
    SocketHand hand(folder.endpoint(), 4);
    const auto push = [&] {
        tick(hand, 2.0);
        return bridge.felt.load() == 2.0;
    };
    REQUIRE(eventually(push));
    CHECK(eventually([&] { return bridge.felt.load() == 0.0; })); // connected, but no packet
    CHECK(bridge.engine.load());
    CHECK(eventually(push));
    bridge.end();
    CHECK(bridge.server.gate().silences() >= 1);
}

TEST_CASE(
    "A bridge that is silent or not homed acts as an open dead-man switch and a clutch, with zero wrench") {
    SocketFolder folder;
    Talk bridge(folder.endpoint());
    SocketHand hand(folder.endpoint(), 4);
    REQUIRE(eventually([&] {
        tick(hand, 2.0);
        return bridge.felt.load() == 2.0;
    }));
    SUBCASE("silent") {
        bridge.mute.store(true);
    }
    SUBCASE("not homed") {
        bridge.status.store(FATHOM_DOOR_PRESENT);
    }
    SUBCASE("device away") {
        bridge.status.store(0);
    }
    bridge.level.store(3.0); // a pose that must not be used
    CHECK(eventually([&] {
        tick(hand, 2.0);
        return !hand.alive();
    }));
    const double before = hand.read(0.0).deviceThandle.position.x;
    CHECK((hand.read(0.0).buttons & 6u) == 6u);
    CHECK(eventually([&] {
        tick(hand, 2.0);
        return bridge.felt.load() == 0.0;
    }));
    CHECK(hand.read(0.0).deviceThandle.position.x == before);
    CHECK(hand.figures().losses >= 1);
    bridge.mute.store(false);
    bridge.status.store(kReady);
    CHECK(eventually([&] {
        tick(hand, 2.0);
        return bridge.felt.load() == 2.0 && hand.alive();
    }));
}

TEST_CASE("A wrench of a wrong version, kind, magic or size ends the connection with zero force") {
    SocketFolder folder;
    SocketServer server(serverAt(folder.endpoint()));
    DeviceSocket engine = DeviceSocket::connect(folder.endpoint());
    uint64_t sequence = 0;
    REQUIRE(eventually([&] { // a good engine first
        engine.send(wrenchPacket(++sequence, 2.0));
        server.poll();
        return server.wrench().force.x == 2.0;
    }));

    fathom_door_wrench packet = wrenchPacket(++sequence, 2.0);
    std::vector<char> bytes(sizeof packet + 8, '\0');
    size_t length = sizeof packet;
    SUBCASE("version") {
        packet.header.version = 2;
    }
    SUBCASE("kind") {
        packet.header.kind = FATHOM_DOOR_HAND;
    }
    SUBCASE("magic") {
        packet.header.magic = 7;
    }
    SUBCASE("size in the header") {
        packet.header.size = 80;
    }
    SUBCASE("half a packet") {
        length = sizeof packet / 2;
    }
    SUBCASE("shorter than a header") {
        length = 5;
    }
    SUBCASE("one byte") {
        length = 1;
    }
    SUBCASE("longer") {
        length = sizeof packet + 8;
    }
    std::memcpy(bytes.data(), &packet, sizeof packet);
    REQUIRE(::send(engine.descriptor(), bytes.data(), length, MSG_NOSIGNAL) == static_cast<ssize_t>(length));
    server.poll();
    CHECK_FALSE(server.hasEngine());
    CHECK(server.wrench().force.x == 0.0);
    CHECK(server.dropped() == 1);
    DeviceSocket next = DeviceSocket::connect(folder.endpoint()); // and the socket accepts the next one
    server.poll();
    CHECK(server.hasEngine());
    CHECK(server.wrench().force.x == 0.0);
}

TEST_CASE("A flood of wrenches does not delay the bridge") {
    SocketFolder folder;
    SocketServer server(serverAt(folder.endpoint()));
    DeviceSocket engine = DeviceSocket::connect(folder.endpoint());
    uint64_t sequence = 0;
    while (engine.send(wrenchPacket(++sequence, 1.0)) == SocketEvent::Packet) {
    }
    CHECK(sequence > 1); // until its queue was full, without waiting
    server.poll();
    server.poll();
    CHECK(server.hasEngine());
}

TEST_CASE("A second engine is rejected and the first one continues") {
    SocketFolder folder;
    Talk bridge(folder.endpoint());
    SocketHand hand(folder.endpoint(), 4);
    CHECK(has(refusalOf([&] { SocketHand(folder.endpoint(), 4); }),
              "closed by the bridge (allowed: a bridge without"));
    CHECK(eventually([&] {
        tick(hand, 1.0);
        return bridge.felt.load() == 1.0;
    }));
}

TEST_CASE(
    "The engine rejects a bridge of another version, a silent bridge, and a socket without a listener") {
    SocketFolder folder;
    const auto attempt = [&] { SocketHand(folder.endpoint(), 4, 0.2); };
    CHECK(has(refusalOf(attempt), "no bridge listens"));
    std::ofstream(folder.endpoint()) << "text";
    CHECK(has(refusalOf([&] { SocketServer(serverAt(folder.endpoint())); }), "exists and is not a socket"));
    std::filesystem::remove(folder.endpoint());

    DeviceSocket endpoint = DeviceSocket::listen(folder.endpoint(), 1);
    CHECK(has(refusalOf([&] { SocketServer(serverAt(folder.endpoint())); }), "another program listens here"));
    DeviceSocket probe = endpoint.accept();
    CHECK(has(refusalOf(attempt), "no sample (allowed: a bridge that sends"));

    std::atomic<bool> stop{false};
    fathom_door_hand packet = handPacket(1, 0.0);
    size_t length = sizeof packet;
    std::string expected;
    SUBCASE("version") {
        packet.header.version = 9;
        expected = "version 9 (allowed: 1)";
    }
    SUBCASE("size") {
        length = sizeof packet - 4;
        expected = "size 148 (allowed: 152)";
    }
    SUBCASE("half a header") {
        length = 16;
        expected = "16 bytes (allowed: 152)";
    }
    std::thread bridge([&] {
        std::vector<DeviceSocket> engines;
        while (!stop.load()) {
            DeviceSocket engine = endpoint.accept();
            if (engine.open() && ::send(engine.descriptor(), &packet, length, MSG_NOSIGNAL) > 0) {
                engines.push_back(std::move(engine));
            }
            pauseMs(1);
        }
    });
    CHECK(has(refusalOf(attempt), expected));
    stop.store(true);
    bridge.join();
}

TEST_CASE("The socket file belongs to its owner only, and is removed with the bridge") {
    SocketFolder folder;
    {
        SocketServer server(serverAt(folder.endpoint()));
        struct stat status {};
        REQUIRE(::stat(folder.endpoint().c_str(), &status) == 0);
        CHECK((status.st_mode & 0777) == 0600);
    }
    CHECK_FALSE(std::filesystem::exists(folder.endpoint()));
    CHECK(has(refusalOf([&] { DeviceSocket::listen(std::string(200, 'x'), 1); }), "200 characters"));
    CHECK(has(refusalOf([&] { DeviceSocket::listen("/proc/no-such-folder/door", 1); }),
              "folder that you may write to"));
}
