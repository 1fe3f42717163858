// SPDX-License-Identifier: Apache-2.0
// The socket between processes: killed ends, a user without permission, the example bridge.
#include "devices/bridge/socket_hand.h"
#include "devices/bridge/socket_server.h"
#include "engine/types/error.h"
#include "tests/devices/socket_rig.h"

#include <glm/geometric.hpp>

#include <sys/stat.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kProcessReady = FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED;

// Serves until killed.
int serve(const std::filesystem::path& endpoint) {
    SocketServer server(serverAt(endpoint));
    for (;;) {
        server.poll();
        server.send({}, kProcessReady);
        pauseMs(1);
    }
}

// [s] from the call until the device's last force. Polls until there was none for 0.3 s. Uses this process's
// clock, so a delayed process never reports a longer force than there was.
double forceLasts(const std::function<double()>& tick) {
    const auto began = std::chrono::steady_clock::now();
    double last = 0.0;
    for (double now = 0.0; now - last < 0.3 && now < 20.0; pauseMs(1)) {
        now = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        last = tick() != 0.0 ? now : last;
    }
    return last;
}

// Connects once the bridge, in another process, listens.
std::unique_ptr<SocketHand> connected(const SocketFolder& folder) {
    std::unique_ptr<SocketHand> hand;
    REQUIRE(eventually([&] {
        try {
            hand = std::make_unique<SocketHand>(folder.endpoint(), 4);
        } catch (const BadInput&) { // not yet
        }
        return hand != nullptr;
    }));
    return hand;
}

// A silence of 10 ms, and the rest for a machine that has other things to do.
constexpr double kLongestForce = 0.2; // [s]

// A handle that yields to the force and returns afterwards.
void checkActsAsDevice(const std::function<int(const char*)>& start) {
    SocketFolder folder;
    const std::string endpoint = folder.endpoint().string();
    Child bridge([&] { return start(endpoint.c_str()); });
    std::unique_ptr<SocketHand> hand = connected(folder);
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
    CHECK_FALSE(std::filesystem::exists(folder.endpoint()));
}

} // namespace

TEST_CASE("After SIGKILL of the engine in contact, the device has zero force within 10 ms") {
    SocketFolder folder;
    SocketServer server(serverAt(folder.endpoint()));
    Child engine([&]() -> int { // presses for ever
        SocketHand hand(folder.endpoint(), 4);
        for (;;) {
            hand.read(0.0);
            hand.write({{2.0, 0.0, 0.0}, {}}, 0.001);
            pauseMs(1);
        }
    });
    const auto tick = [&] {
        server.poll();
        server.send({}, kProcessReady);
        return server.wrench().force.x;
    };
    REQUIRE(eventually([&] { return tick() == 2.0; }));
    SUBCASE("killed") {
        engine.signal(SIGKILL);
        CHECK(forceLasts(tick) < kLongestForce);
        CHECK_FALSE(server.hasEngine());
        CHECK(engine.wait() == -SIGKILL);
    }
    SUBCASE("killed, and known to be") {
        engine.signal(SIGKILL);
        CHECK(engine.wait() == -SIGKILL);
        CHECK(tick() == 0.0); // its end is closed: no need to wait for the 10 ms
        CHECK_FALSE(server.hasEngine());
    }
    SUBCASE("stopped, as by a debugger") {
        engine.signal(SIGSTOP);
        CHECK(forceLasts(tick) < kLongestForce);
        CHECK(server.hasEngine());
        engine.signal(SIGCONT);
        CHECK(eventually([&] { return tick() == 2.0; }));
    }
}

TEST_CASE("After SIGKILL of a bridge the dead-man switch opens, and the engine reconnects to the next one by "
          "itself") {
    SocketFolder folder;
    Child first([&] { return serve(folder.endpoint()); });
    std::unique_ptr<SocketHand> hand = connected(folder);
    const auto tick = [&] {
        const HandSample sample = hand->read(0.0);
        hand->write({{1.0, 0.0, 0.0}, {}}, 0.001);
        return sample.buttons;
    };
    REQUIRE(eventually([&] { return tick() == 0; }));
    first.signal(SIGKILL);
    CHECK(first.wait() == -SIGKILL);
    CHECK(eventually([&] { return tick() == 6; }));
    CHECK_FALSE(hand->alive());
    CHECK(std::filesystem::exists(folder.endpoint())); // the dead one left its file
    Child second([&] { return serve(folder.endpoint()); });
    CHECK(eventually([&] { return tick() == 0; }));
    CHECK(hand->alive());
    CHECK(hand->figures().losses == 1);
}

TEST_CASE("A user without permission on the socket file gets no connection") {
    if (::geteuid() != 0) {
        MESSAGE("SKIPPED: not root, so it cannot become another user");
        return;
    }
    SocketFolder folder;
    ::chmod(folder.path().c_str(), 0755); // the folder is not what stops him
    SocketServer server(serverAt(folder.endpoint()));
    const auto asNobody = [&] {
        Child other([&] {
            if (::setgid(65534) != 0 || ::setuid(65534) != 0) {
                return 98;
            }
            try {
                DeviceSocket::connect(folder.endpoint());
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
    ::chmod(folder.endpoint().c_str(), 0666); // its owner opens it
    CHECK(asNobody() == 0);
}

TEST_CASE("The example bridges in C and Python act as a device: the handle yields to the force and returns "
          "afterwards") {
    checkActsAsDevice(
        [](const char* endpoint) { return ::execl(EXAMPLE_BRIDGE, "example_bridge", endpoint, nullptr); });
    constexpr const char* kPython = "/usr/bin/python3";
    if (std::filesystem::exists(kPython)) {
        checkActsAsDevice([](const char* endpoint) {
            return ::execl(kPython, "python3", "devices/bridge/example_bridge.py", endpoint, nullptr);
        });
    }
}

TEST_CASE("The example bridge exits cleanly when its terminal closes, and continues without a reader of its "
          "output") {
    for (const int ending : {SIGINT, SIGQUIT, SIGHUP}) {
        CAPTURE(ending);
        SocketFolder folder;
        const std::string endpoint = folder.endpoint().string();
        Child bridge([&] {
            std::signal(SIGHUP, SIG_DFL);
            return ::execl(EXAMPLE_BRIDGE, "example_bridge", endpoint.c_str(), nullptr);
        });
        std::unique_ptr<SocketHand> hand = connected(folder);
        bridge.signal(SIGPIPE);
        CHECK(eventually([&] {
            const HandSample sample = hand->read(0.0);
            hand->write({{0.0, 0.0, 3.0}, {}}, 0.001);
            pauseMs(1);
            return sample.buttons == 0 && sample.deviceThandle.position.z > 0.009;
        }));
        bridge.signal(ending);
        CHECK(bridge.wait() == 0);
        CHECK_FALSE(std::filesystem::exists(folder.endpoint()));
    }
}
