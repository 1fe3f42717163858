// SPDX-License-Identifier: Apache-2.0
// The bridge of an Inverse3 between an engine and a simulated service.
#include "devices/bridge/socket_hand.h"
#include "devices/haply/haply_bridge.h"
#include "devices/haply/haply_message.h"
#include "engine/types/error.h"
#include "tests/devices/haply_service.h"
#include "tests/devices/socket_rig.h"
#include "tests/support/refusal.h"

#include <cmath>
#include <optional>

using namespace fathom;
using namespace fathom::testing;

namespace {

// The bridge on its own thread, and an engine that pushes with 2 N along z.
struct Loop {
    explicit Loop(uint16_t port)
        : bridge({folder.endpoint(), "127.0.0.1", port, ""})
        , thread([this] { bridge.run(stop); })
        , hand(folder.endpoint(), 4) {}
    ~Loop() { end(); }
    void end() {
        stop = true;
        if (thread.joinable()) {
            thread.join();
        }
    }
    HandSample step() {
        const HandSample sample = hand.read(t += 0.001);
        hand.write({{0.0, 0.0, 2.0}, {}}, 0.001);
        pauseMs(1);
        return sample;
    }
    bool until(const std::function<bool(const HandSample&)>& wanted) {
        return eventually([&] { return wanted(step()); });
    }

    SocketFolder folder;
    HaplyBridge bridge;
    std::atomic<bool> stop{false};
    std::thread thread;
    SocketHand hand;
    double t = 0.0;
};

} // namespace

TEST_CASE("The pose of an Inverse3 reaches the engine, the engine's force reaches the service, and the last "
          "force is zero") {
    HaplyService service;
    Loop loop(service.port());
    CHECK(loop.bridge.place().find("049D at ws://127.0.0.1:") == 0);
    CHECK(loop.hand.preset() == "inverse3");
    CHECK(
        loop.until([](const HandSample& s) { return s.deviceThandle.position == dvec3(0.01, -0.12, 0.1); }));
    service.z = 0.15;
    CHECK(loop.until([](const HandSample& s) { return s.deviceThandle.position.z == 0.15; }));
    CHECK(loop.until([&](const HandSample&) { return service.force() == std::array{0.0, 0.0, 2.0}; }));
    CHECK(service.first()["session"]["configure"]["profile"]["name"] == "fathom");
    loop.end(); // with the engine still pushing
    CHECK(service.force() == std::array{0.0, 0.0, 0.0});
    CHECK(loop.bridge.figures().faults == 0);
}

TEST_CASE("An engine that is silent for 10 ms leaves zero force at the service") {
    HaplyService service;
    Loop loop(service.port());
    CHECK(loop.until([&](const HandSample&) { return service.force()[2] == 2.0; }));
    CHECK(eventually([&] { return service.force()[2] == 0.0; })); // no tick meanwhile
    CHECK(loop.until([&](const HandSample&) { return service.force()[2] == 2.0; }));
}

TEST_CASE("A VerseGrip gives orientation and buttons; without one the orientation is constant") {
    HaplyService service;
    Loop loop(service.port());
    CHECK(loop.until([&](const HandSample& s) { return s.deviceThandle.position.z == 0.1; }));
    CHECK(loop.step().deviceThandle.rotation == dquat(1.0, 0.0, 0.0, 0.0));
    CHECK(loop.step().buttons == 0);
    service.grip = service.button = true;
    CHECK(loop.until([](const HandSample& s) {
        return std::abs(s.deviceThandle.rotation.x) > 0.999 && (s.buttons & FATHOM_DOOR_GUIDANCE) != 0;
    }));
}

TEST_CASE("Of a VerseGrip's buttons a is guidance and b is the clutch") {
    for (const bool a : {false, true}) {
        for (const bool b : {false, true}) {
            const auto text = [](bool down) { return std::string(down ? "true" : "false"); };
            const auto state = readHaplyState(
                R"({"inverse3": [{"device_id": "1", "state": {"cursor_position": {"x": 0, "y": 0, "z": 0}}}],
                    "verse_grip": [{"device_id": "2", "state": {"orientation": {"w": 1, "x": 0, "y": 0, "z": 0},
                    "buttons": {"a": )" +
                    text(a) + R"(, "b": )" + text(b) + "}}}]}",
                "");
            REQUIRE(state.has_value());
            CHECK(state->sample.buttons == ((a ? FATHOM_DOOR_GUIDANCE : 0u) | (b ? FATHOM_DOOR_CLUTCH : 0u)));
        }
    }
}

TEST_CASE("Fragmented, invalid and missing answers do not stop the exchange") {
    HaplyService service;
    Loop loop(service.port());
    service.fragments = true;
    service.z = 0.2;
    CHECK(loop.until([](const HandSample& s) { return s.deviceThandle.position.z == 0.2; }));
    CHECK(eventually([&] { return service.pongs > 0; }));
    service.fragments = false;
    service.garbage = 3;
    service.z = 0.21;
    CHECK(loop.until([](const HandSample& s) { return s.deviceThandle.position.z == 0.21; }));
    const uint64_t asked = service.messages;
    service.mute = true;
    CHECK(eventually([&] { return service.messages > asked + 2; })); // asked again
    service.mute = false;
    service.z = 0.22;
    CHECK(loop.until([](const HandSample& s) { return s.deviceThandle.position.z == 0.22; }));
    loop.end();
    CHECK(loop.bridge.figures().faults == 3);
    CHECK(loop.bridge.figures().late >= 2);
}

TEST_CASE("Late answers of the service are dropped, and never make the hand's pose older") {
    HaplyService service;
    Loop loop(service.port());
    REQUIRE(loop.until([](const HandSample& s) { return s.deviceThandle.position.z == 0.1; }));
    for (const double z : {0.2, 0.3, 0.4}) {
        service.hold = true; // first: an answer with the next pose must not go out before
        service.z = -z;
        const uint64_t asked = service.messages;
        REQUIRE(eventually([&] { return service.messages > asked + 3; }));
        service.z = z;
        service.hold = false; // all at once
        bool old = false;
        CHECK(loop.until([&](const HandSample& s) {
            old = old || s.deviceThandle.position.z == -z;
            return s.deviceThandle.position.z == z;
        }));
        CHECK_FALSE(old);
    }
    loop.end();
    CHECK(loop.bridge.figures().surplus >= 6);
}

TEST_CASE("A device pulled out of the service, and a service that ends, open the dead-man switch until they "
          "are back") {
    std::optional<HaplyService> service(std::in_place);
    const uint16_t port = service->port();
    Loop loop(port);
    const auto there = [&](bool wanted) { // and stays so
        int ticks = 0;
        return loop.until([&](const HandSample&) {
            ticks = loop.hand.alive() == wanted ? ticks + 1 : 0;
            return ticks >= 20;
        });
    };
    REQUIRE(there(true));
    service->other = true;
    service->z = 0.3;
    CHECK(loop.until([](const HandSample& s) { return s.deviceThandle.position.z == 0.3; }));
    CHECK(there(true));
    service->device = false; // the other one is not taken for it
    CHECK(there(false));
    CHECK(eventually([&] { return service->force()[2] == 0.0; }));
    service->device = true;
    CHECK(there(true));
    service->hangUps = 1; // closes in the middle of it
    CHECK(there(false));
    CHECK(there(true));
    service.reset();
    CHECK(there(false));
    service.emplace(port);
    CHECK(there(true));
    CHECK(loop.until([&](const HandSample&) { return service->force()[2] == 2.0; }));
    loop.end();
    CHECK(loop.bridge.losses() >= 3);
}

TEST_CASE("A missing service, WebSocket or Inverse3, or another Inverse3, is reported") {
    SocketFolder folder;
    const auto said = [&](uint16_t port, const std::string& device = "") {
        return refusalOf<Error>([&] { HaplyBridge({folder.endpoint(), "127.0.0.1", port, device}); });
    };
    uint16_t port = 0;
    {
        HaplyService service;
        port = service.port();
        CHECK(said(port, "0123").find("has no Inverse3 '0123'") != std::string::npos);
        service.strange = true;
        CHECK(said(port).find("not a WebSocket") != std::string::npos);
        service.strange = false;
        service.device = false;
        CHECK(said(port).find("has no Inverse3") != std::string::npos);
    }
    CHECK(said(port).find("Connection refused (allowed: a running Haply Inverse Service") !=
          std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.endpoint()));
}
