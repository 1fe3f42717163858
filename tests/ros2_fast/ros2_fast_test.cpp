// SPDX-License-Identifier: Apache-2.0
// Topics of ROS 2 with a program on Fast DDS, which reads and writes messages with Fast CDR
// (tests/ros2_fast_peer).
#include "devices/ros2/ros2_camera.h"
#include "tests/ros2/bridge_loop.h"
#include "tests/ros2/client.h"
#include "tests/ros2/fed_run.h"
#include "tests/ros2/topic_listener.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kPose = "/haptic/pose";

bool isAt(const HandSample& sample, double x) {
    return sample.present && sample.deviceThandle.position.x == x;
}

} // namespace

TEST_CASE("Fast DDS subscribers read wrenches, poses, velocities, regions and diagnostics of a run") {
    FedRun run("/fathom,twist=/twist");
    TopicListener wrench("/fathom/wrench", "WrenchStamped"), tool("/fathom/tool_pose", "PoseStamped"),
        twist("/twist", "TwistStamped"), cloud("/fathom/regions", "PointCloud2"),
        diagnostics("/diagnostics", "DiagnosticArray");
    const Line first = wrench.next();
    CHECK(first.is("base 1 2 3 0.1 0.2 0.3"));
    CHECK(std::abs(first.stamp() - utcNow()) < 60.0);
    CHECK(tool.next().is("base 0.25 -0.5 0.75 0.5 0.5 0.5 0.5"));
    CHECK(twist.next().is("base 0 0 0 0 0 0"));
    CHECK(cloud.next().is("base x,y,z,radius,class 3 1 20 60 10.5 -0.25 1 0.0625 2"));
    CHECK(diagnostics
              .until([](const Line& line) { return line.holds(" 0 fathom: forces contact force_n=3.742"); })
              .any());
}

TEST_CASE("Fast DDS subscribers that are late or killed do not keep messages from others") {
    FedRun run("/fathom");
    TopicListener wrench("/fathom/wrench", "WrenchStamped");
    REQUIRE(wrench.next().any());
    {
        TopicListener late("/fathom/wrench", "WrenchStamped"), cloud("/fathom/regions", "PointCloud2");
        CHECK(late.next().any());
        CHECK(cloud.next().any()); // of a set that was made long before
    }
    run.change([](TickRow& row) { row.record.wrench.force.x = 7.0; });
    CHECK(wrench.until([](const Line& line) { return line.number(2) == 7.0; }).any());
}

TEST_CASE("A Fast DDS node moves the hand and gets its force; killed, it counts as gone, and its successor "
          "is used") {
    BridgeLoop loop(kPose);
    TopicListener force("/haptic/wrench", "WrenchStamped");
    auto node = std::make_unique<Speaker>(kPose, "PoseStamped");
    CHECK(loop.until(node.get(), "0.1 0 0 0 0 0 1",
                     [](const HandSample& sample) { return isAt(sample, 0.1); }));
    loop.until(node.get(), "0.1 0 0 0 0 0 1", [n = 0](const HandSample&) mutable { return ++n == 300; });
    CHECK(force.until([](const Line& line) { return line.words(1, 4) == "handle_base 0 0 2"; }).any());
    node.reset();
    CHECK(loop.until(nullptr, "", [](const HandSample& sample) { return !sample.present; }));
    CHECK(force.until([](const Line& line) { return line.number(4) == 0.0; }).any());
    Speaker successor(kPose, "PoseStamped");
    CHECK(loop.until(&successor, "0.2 0 0 0 0 0 1",
                     [](const HandSample& sample) { return isAt(sample, 0.2); }));
}

TEST_CASE("Another type on the topic, messages that end early and big-endian ones do not move the hand") {
    BridgeLoop loop(kPose);
    Speaker stranger(kPose, "TwistStamped");
    bool moved = false;
    loop.until(&stranger, "0.3 0 0 0 0 1", [&, n = 0](const HandSample& sample) mutable {
        moved = moved || sample.present;
        return ++n == 300;
    });
    CHECK_FALSE(moved);
    CHECK(loop.bridge->figures().faults == 0);
    Speaker node(kPose, "PoseStamped");
    REQUIRE(loop.until(&node, "0.1 0 0 0 0 0 1", [](const HandSample& sample) { return isAt(sample, 0.1); }));
    for (const std::string broken : {"short", "big 0.3 0 0 0 0 0 1", "0.3 0 0"}) {
        const uint64_t before = loop.bridge->figures().faults;
        CHECK(loop.until(&node, broken, [&](const HandSample& sample) {
            moved = moved || (sample.present && sample.deviceThandle.position.x == 0.3);
            return loop.bridge->figures().faults >= before + 3;
        }));
    }
    CHECK_FALSE(moved);
    CHECK(loop.until(&node, "0.2 0 0 0 0 0 1", [](const HandSample& sample) { return isAt(sample, 0.2); }));
}

TEST_CASE("A camera reads images of a Fast DDS driver, which are larger than a packet of the network") {
    Speaker depth("/camera/depth/image_raw", "Image"), info("/camera/depth/camera_info", "CameraInfo");
    std::atomic<bool> stop{false};
    std::thread driver([&] {
        for (int i = 0; !stop; ++i) {
            info.say("640 480 600");
            depth.say("640 480 " + std::to_string(i % 2 == 0 ? 700 : 900));
            pauseMs(20);
        }
    });
    {
        Ros2Camera camera(parseRos2Request("ros2:depth=/camera/depth/image_raw,wait=60,domain=" +
                                           std::to_string(testDomain())));
        CHECK(camera.info().depth.width == 640);
        CHECK(camera.info().depth.fx == 600.0);
        bool whole = true;
        std::set<uint16_t> values;
        for (int i = 0; i < 20; ++i) {
            const auto frame = camera.next();
            REQUIRE(frame);
            const auto& pixels = (*frame)->depth;
            values.insert(pixels[0]);
            whole = whole && pixels.size() == 640 * 480 &&
                    std::all_of(pixels.begin(), pixels.end(), [&](uint16_t v) { return v == pixels[0]; });
        }
        CHECK(whole);
        CHECK(values == std::set<uint16_t>{700, 900});
    }
    stop = true;
    driver.join();
}

TEST_CASE(
    "A Fast DDS client that sends what rmw_cyclonedds sends calls services; one of rmw_fastrtps is skipped") {
    FedRun run("/fathom,commands=on");
    Client off("/fathom/forces_off", "Trigger"), freeze("/fathom/freeze", "SetBool");
    CHECK(off.call("rmw_fastrtps") == "ok");
    CHECK(off.call("") == "2 1 forces are switched off");
    CHECK(run.observer().takeRequests().forcesOff);
    CHECK(freeze.call("1") == "1 1 fixtures are frozen");
    CHECK(run.observer().takeRequests().frozen == true);
    CHECK(freeze.call("0") == "2 1 fixtures are released");
    CHECK(run.observer().takeRequests().frozen == false);
}
