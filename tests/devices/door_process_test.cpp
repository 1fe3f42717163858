// SPDX-License-Identifier: Apache-2.0
// The door between processes: ends that are killed, a user without permission, the example bridge.
#include "devices/bridge/door_hand.h"
#include "devices/bridge/door_server.h"
#include "engine/types/error.h"
#include "tests/devices/door_rig.h"

#include <glm/geometric.hpp>

#include <sys/stat.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kProcessReady = FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED;

// Serves until killed.
int serve(const std::filesystem::path& door) {
    DoorServer server(serverAt(door));
    for (;;) {
        server.poll();
        server.send({}, kProcessReady);
        pauseMs(1);
    }
}

// [s] from now on until the device had a force for the last time: by the clock of who asks, so that one that
// is not let run sees no force for longer than there was. Until there has been none for 0.3 s.
double forceLasts(const std::function<double()>& turn) {
    const auto began = std::chrono::steady_clock::now();
    double last = 0.0;
    for (double now = 0.0; now - last < 0.3 && now < 20.0; pauseMs(1)) {
        now = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        last = turn() != 0.0 ? now : last;
    }
    return last;
}

// A silence of 10 ms, and the rest for a machine that has other things to do.
constexpr double kLongestForce = 0.2; // [s]

} // namespace

TEST_CASE("An engine killed by SIGKILL in contact is zero force at the device, within 10 ms") {
    DoorFolder folder;
    DoorServer server(serverAt(folder.door()));
    Child engine([&]() -> int { // presses for ever
        DoorHand hand(folder.door(), 4);
        for (;;) {
            hand.read(0.0);
            hand.write({{2.0, 0.0, 0.0}, {}}, 0.001);
            pauseMs(1);
        }
    });
    const auto turn = [&] {
        server.poll();
        server.send({}, kProcessReady);
        return server.wrench().force.x;
    };
    REQUIRE(eventually([&] { return turn() == 2.0; }));
    SUBCASE("killed") {
        engine.signal(SIGKILL);
        CHECK(forceLasts(turn) < kLongestForce);
        CHECK_FALSE(server.hasEngine());
        CHECK(engine.wait() == -SIGKILL);
    }
    SUBCASE("killed, and known to be") {
        engine.signal(SIGKILL);
        CHECK(engine.wait() == -SIGKILL);
        CHECK(turn() == 0.0); // its end is closed: no need to wait for the 10 ms
        CHECK_FALSE(server.hasEngine());
    }
    SUBCASE("stopped, as by a debugger") {
        engine.signal(SIGSTOP);
        CHECK(forceLasts(turn) < kLongestForce);
        CHECK(server.hasEngine());
        engine.signal(SIGCONT);
        CHECK(eventually([&] { return turn() == 2.0; }));
    }
}

TEST_CASE(
    "A bridge killed by SIGKILL opens the dead-man switch, and the engine finds the next one by itself") {
    DoorFolder folder;
    Child first([&] { return serve(folder.door()); });
    std::unique_ptr<DoorHand> hand;
    REQUIRE(eventually([&] {
        try {
            hand = std::make_unique<DoorHand>(folder.door(), 4);
        } catch (const BadInput&) { // the child has not got there yet
        }
        return hand != nullptr;
    }));
    const auto turn = [&] {
        const HandSample sample = hand->read(0.0);
        hand->write({{1.0, 0.0, 0.0}, {}}, 0.001);
        return sample.buttons;
    };
    REQUIRE(eventually([&] { return turn() == 0; }));
    first.signal(SIGKILL);
    CHECK(first.wait() == -SIGKILL);
    CHECK(eventually([&] { return turn() == 6; }));
    CHECK_FALSE(hand->alive());
    CHECK(std::filesystem::exists(folder.door())); // the dead one left its file
    Child second([&] { return serve(folder.door()); });
    CHECK(eventually([&] { return turn() == 0; }));
    CHECK(hand->alive());
    CHECK(hand->figures().losses == 1);
}

TEST_CASE("A user without permission on the socket file gets no connection") {
    if (::geteuid() != 0) {
        MESSAGE("not root: cannot become another user, not checked");
        return;
    }
    DoorFolder folder;
    ::chmod(folder.path().c_str(), 0755); // the folder is not what stops him
    DoorServer server(serverAt(folder.door()));
    const auto asNobody = [&] {
        Child other([&] {
            if (::setgid(65534) != 0 || ::setuid(65534) != 0) {
                return 98;
            }
            try {
                DoorSocket::connect(folder.door());
            } catch (const BadInput& e) {
                return std::string(e.what()).find("no permission") != std::string::npos ? 1 : 97;
            }
            return 0;
        });
        return other.wait();
    };
    CHECK(asNobody() == 1);
    server.poll();
    CHECK_FALSE(server.hasEngine());
    ::chmod(folder.door().c_str(), 0666); // its owner opens it
    CHECK(asNobody() == 0);
}

TEST_CASE(
    "The example bridge is a device: its handle gives way to the force and comes back when it is gone") {
    DoorFolder folder;
    const std::string door = folder.door().string();
    Child bridge([&] { return ::execl(EXAMPLE_BRIDGE, "example_bridge", door.c_str(), nullptr); });
    std::unique_ptr<DoorHand> hand;
    REQUIRE(eventually([&] {
        try {
            hand = std::make_unique<DoorHand>(folder.door(), 4);
        } catch (const BadInput&) {
        }
        return hand != nullptr;
    }));
    CHECK(hand->preset() == "falcon");
    const auto height = [&](double fz) {
        const HandSample sample = hand->read(0.0);
        hand->write({{0.0, 0.0, fz}, {}}, 0.001);
        pauseMs(1);
        return sample.buttons == 0 ? sample.deviceThandle.position.z : 0.0;
    };
    CHECK(eventually([&] { return height(3.0) > 0.009; })); // 3 N on 300 N/m
    CHECK(eventually([&] { return height(0.0) < 0.001; }));
    CHECK(eventually([&] { return height(3.0) > 0.009; }));
    CHECK(eventually([&] { return hand->read(0.0).deviceThandle.position.z < 0.001; })); // silence
    hand.reset();
    bridge.signal(SIGTERM);
    CHECK(bridge.wait() == 0);
    CHECK_FALSE(std::filesystem::exists(folder.door()));
}

TEST_CASE("The example bridge ends in order when its terminal is closed, and goes on without a reader") {
    for (const int ending : {SIGINT, SIGQUIT, SIGHUP}) {
        CAPTURE(ending);
        DoorFolder folder;
        const std::string door = folder.door().string();
        Child bridge([&] {
            std::signal(SIGHUP, SIG_DFL);
            return ::execl(EXAMPLE_BRIDGE, "example_bridge", door.c_str(), nullptr);
        });
        std::unique_ptr<DoorHand> hand;
        REQUIRE(eventually([&] {
            try {
                hand = std::make_unique<DoorHand>(folder.door(), 4);
            } catch (const BadInput&) {
            }
            return hand != nullptr;
        }));
        bridge.signal(SIGPIPE);
        CHECK(eventually([&] {
            const HandSample sample = hand->read(0.0);
            hand->write({{0.0, 0.0, 3.0}, {}}, 0.001);
            pauseMs(1);
            return sample.buttons == 0 && sample.deviceThandle.position.z > 0.009;
        }));
        bridge.signal(ending);
        CHECK(bridge.wait() == 0);
        CHECK_FALSE(std::filesystem::exists(folder.door()));
    }
}
