// SPDX-License-Identifier: Apache-2.0
// A haptic device that is a node of ROS 2: its poses come from tests/ros2_speaker, its force goes to
// tests/ros2_listener.
#include "devices/ros2/received_messages.h"
#include "engine/types/error.h"
#include "tests/ros2/bridge_loop.h"
#include "tests/ros2/topic_listener.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kPoseTopic = "/haptic/pose", kRest = "0.1 0.2 0.3 0 0 0 1";

// A bridge, its engine, and the device's node.
struct TopicLoop : BridgeLoop {
    explicit TopicLoop(const std::string& more = "")
        : BridgeLoop(kPoseTopic, more)
        , node(kPoseTopic, "PoseStamped") {}
    void say(const std::string& line) { node.say(line); }
    bool until(const std::string& line, const std::function<bool(const HandSample&)>& wanted) {
        return BridgeLoop::until(&node, line, wanted);
    }

    Speaker node;
};

bool near(const HandSample& sample, const dvec3& position) {
    return sample.present && glm::distance(sample.deviceThandle.position, position) < 1e-12;
}

std::string topicsRefusal(const std::string& text) {
    return refusalOf([&] { parseRos2HandRequest(text); });
}

} // namespace

TEST_CASE("The poses of a node of ROS 2 move the hand, and its topic gets the engine's force") {
    TopicLoop loop;
    TopicListener force("/haptic/wrench", "WrenchStamped");
    CHECK(loop.hand.preset() == "falcon");
    CHECK(loop.until(kRest, [](const HandSample& sample) { return near(sample, {0.1, 0.2, 0.3}); }));
    CHECK(loop.until("0.1 0.2 0.3 0.5 -0.1 0.7 0.5", [](const HandSample& sample) { // x, y, z, w
        return std::abs(dot(sample.deviceThandle.rotation, glm::dquat(0.5, 0.5, -0.1, 0.7))) > 1.0 - 1e-9;
    }));
    std::thread moves([&] { loop.until(kRest, [&](const HandSample&) { return loop.stop.load(); }); });
    const bool felt =
        force.until([](const Line& line) { return line.words(1, 4) == "handle_base 0 0 2"; }).any();
    loop.stop = true;
    moves.join();
    CHECK(felt);
    CHECK(force.until([](const Line& line) { return line.number(4) == 0.0; }).any()); // the last one
}

TEST_CASE("The force is zero while the engine is silent") {
    TopicLoop loop;
    TopicListener force("/haptic/wrench", "WrenchStamped");
    CHECK(loop.until(kRest, [](const HandSample& sample) { return sample.present; }));
    loop.until(kRest, [n = 0](const HandSample&) mutable { return ++n == 300; });
    CHECK(force.until([](const Line& line) { return line.number(4) > 0.5; }).any());
    CHECK(
        force.until([](const Line& line) { return line.number(4) == 0.0; }).any()); // nothing more is written
}

TEST_CASE("A node without poses counts as gone and gets no force, and its hand is used when poses return") {
    TopicLoop loop;
    REQUIRE(loop.until(kRest, [](const HandSample& sample) { return sample.present; }));
    CHECK(loop.until("", [silent = 0](const HandSample& sample) mutable { // not only for a moment
        silent = sample.present ? 0 : silent + 1;
        return silent == 100;
    }));
    CHECK(loop.until("0.2 0.2 0.3 0 0 0 1", [](const HandSample& sample) {
        return near(sample, {0.2, 0.2, 0.3});
    }));
    loop.stop = true;
}

TEST_CASE("Poses that end early, are not finite or not rotations are skipped, and the hand stays") {
    TopicLoop loop;
    REQUIRE(loop.until(kRest, [](const HandSample& sample) { return sample.present; }));
    bool moved = false;
    for (const std::string line :
         {"nan 0 0 0 0 0 1", "0 0 inf 0 0 0 1", "0 0 0 0 0 0 0", "0 0 0 1 1 0 1", "11 0 0 0 0 0 1"}) {
        loop.until(kRest, [&, n = 0](const HandSample& sample) mutable {
            loop.say(line);
            moved = moved || (sample.present && !near(sample, {0.1, 0.2, 0.3}));
            return ++n == 20;
        });
    }
    CHECK_FALSE(moved);
    loop.say("short"); // from another publisher, heard when the first is silent
    CHECK(eventually(
        [&] {
            loop.say("short");
            pauseMs(10);
            return loop.bridge->figures().faults >= 101;
        },
        60));
    CHECK(loop.until(kRest, [](const HandSample& sample) { return near(sample, {0.1, 0.2, 0.3}); }));
}

TEST_CASE("Buttons of a joystick give guidance, clutch and dead-man switch, which is open without messages") {
    TopicLoop loop(",joy=/haptic/joy,guidance=2,dead_man=3");
    Peer joy(ROS2_SPEAKER, {std::to_string(testDomain()), "/haptic/joy", "Joy"});
    REQUIRE(joy.line() == "ready");
    const auto becomes = [&](const std::string& buttons, uint32_t wanted) {
        return loop.until(kRest, [&](const HandSample& sample) {
            if (!buttons.empty()) {
                joy.send(buttons);
                joy.line();
            }
            return sample.present && sample.buttons == wanted;
        });
    };
    CHECK(becomes("", FATHOM_DOOR_DEAD_MAN_OPEN));
    CHECK(becomes("0 0 0 1", 0));
    CHECK(becomes("0 0 1 1", FATHOM_DOOR_GUIDANCE));
    CHECK(becomes("0 1 0 1", FATHOM_DOOR_CLUTCH));
    CHECK(becomes("0 0", FATHOM_DOOR_DEAD_MAN_OPEN));
    CHECK(becomes("0 0 0 1", 0));
    CHECK(becomes("", FATHOM_DOOR_DEAD_MAN_OPEN));
}

TEST_CASE("Buttons of a joystick are counted before memory is taken") {
    std::vector<uint8_t> joy{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0,    0,    1,    0,
                             0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0x7f};
    CHECK_THROWS_WITH_AS(ros2::joyButtons(joy),
                         doctest::Contains("2147483647 buttons (allowed: at most 256)"), Error);
    joy[24] = 2, joy[25] = joy[26] = joy[27] = 0;
    CHECK_THROWS_WITH_AS(ros2::joyButtons(joy), "truncated", Error);
}

TEST_CASE("A request for a device of ROS 2 names what is wrong in it") {
    CHECK(topicsRefusal("").find("guard: --topics: missing (allowed: pose=TOPIC") == 0);
    CHECK(topicsRefusal("wrench=/a").find("--topics: pose: wrench=/a (allowed: pose=TOPIC") == 0);
    CHECK(topicsRefusal("pose=/a,dead_man=1")
              .find("--topics: dead_man: 1 (allowed: together with joy=TOPIC)") == 0);
    CHECK(topicsRefusal("pose=/a,joy=/j,clutch=256")
              .find("--topics: clutch: 256 (allowed: a button's number") == 0);
    CHECK(topicsRefusal("pose=/a,force=/b").find("--topics: force: /b (allowed: pose=TOPIC") == 0);
    CHECK(parseRos2HandRequest("pose=/a/b/pose").wrench == "/a/b/wrench");
    CHECK(parseRos2HandRequest("pose=/pose").wrench == "/wrench");
}
