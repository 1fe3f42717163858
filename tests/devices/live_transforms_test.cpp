// SPDX-License-Identifier: Apache-2.0
// Poses between frames from messages of tf2_msgs/msg/TFMessage, without a network.
#include "devices/bag/byte_writer.h"
#include "devices/ros2/moving_camera.h"
#include "tests/devices/live_node.h"
#include "tests/realtime/listening.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;
using namespace fathom::testing;

namespace {

// base -> arm -> wrist -> camera, and base -> table.
struct Graph {
    LiveTransforms transforms{"test"};
    LiveNode node;

    void says(double stamp, const std::string& parent, const std::string& child, const Pose& pose,
              bool isStatic = false, const LiveNode& from = {}) {
        transforms.take(
            from.sends(ros2::transform({LiveNode::nanoseconds(stamp), ""}, {parent, child, pose}), stamp),
            isStatic);
    }
    void fixed() {
        says(0.0, "base", "arm", {{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0, 0.0}}, true);
        says(0.0, "wrist", "/camera", {{0.0, 0.5, 0.0}, {1.0, 0.0, 0.0, 0.0}}, true);
        says(0.0, "base", "table", {{2.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}}, true);
    }
    void wrist(double stamp, double x, double turn = 0.0) {
        says(stamp, "arm", "wrist", {{x, 0.0, 0.0}, glm::angleAxis(turn, dvec3(0.0, 0.0, 1.0))});
    }
    LiveTransforms::Answer at(double stamp, const std::string& to = "base") const {
        return transforms.pose("camera", to, LiveNode::kUtc + stamp);
    }
    std::string fault(double stamp, bool early) const {
        const LiveTransforms::Answer answer = at(stamp);
        CHECK_FALSE(answer.pose);
        CHECK(answer.early == early);
        return answer.why;
    }
};

bool isAt(const LiveTransforms::Answer& answer, const dvec3& position) {
    return answer.pose && glm::length(answer.pose->position - position) < 1e-6;
}

LivePairs::Pair pairAt(double stamp, double arrival) {
    return {{LiveNode::kUtc + stamp, LiveNode().sends({}, arrival).message}, std::nullopt};
}

} // namespace

TEST_CASE("A pose is the chain of fixed and moving transforms at its time, interpolated") {
    Graph graph;
    graph.fixed();
    graph.wrist(1.0, 0.25);
    graph.wrist(1.1, 0.75, 1.0);
    CHECK(isAt(graph.at(1.0), {0.25, 0.5, 1.0}));
    CHECK(isAt(graph.at(1.025), {0.375 - 0.5 * std::sin(0.25), 0.5 * std::cos(0.25), 1.0}));
    CHECK(isAt(graph.at(1.1), {0.75 - 0.5 * std::sin(1.0), 0.5 * std::cos(1.0), 1.0}));
    CHECK(isAt(graph.at(1.0, "table"), {1.75, -0.5, 1.0})); // another branch, turned by half
    CHECK(isAt(graph.at(5.0, "wrist"), {0.0, 0.5, 0.0}));   // fixed: at all times
}

TEST_CASE("There is no pose before, after or in a gap of the transforms, and the reason names the frame") {
    Graph graph;
    CHECK(graph.fault(1.0, true) == "no transforms between 'camera' and 'base'");
    graph.fixed();
    CHECK(graph.fault(1.0, true) == "no transforms between 'camera' and 'base'");
    graph.wrist(1.0, 0.0);
    graph.wrist(1.1, 0.0);
    graph.wrist(1.7, 0.0);
    CHECK(graph.fault(0.9, false) == "/tf of 'wrist' begins after it");
    CHECK(graph.fault(1.4, false) == "/tf of 'wrist' has a gap there");
    CHECK(graph.fault(1.8, true) == "/tf of 'wrist' ends before it");
    CHECK(graph.at(1.05).pose);
}

TEST_CASE("Transforms may come in another order and more than once; old ones are forgotten") {
    Graph graph;
    graph.fixed();
    graph.wrist(1.2, 0.2);
    graph.wrist(1.0, 0.0);
    graph.wrist(1.2, 0.4);
    CHECK(isAt(graph.at(1.1), {0.2, 0.5, 1.0}));
    for (int i = 0; i < 5000; ++i) {
        graph.wrist(1.3 + 0.001 * i, 0.0);
    }
    CHECK(graph.fault(1.1, false) == "/tf of 'wrist' begins after it");
    CHECK(graph.at(6.2).pose);
}

TEST_CASE("After a clock was set back, its transforms count from the fifth one on") {
    Graph graph;
    graph.fixed();
    graph.wrist(100.0, 0.0);
    for (int i = 0; i < 4; ++i) {
        graph.wrist(10.0 + i, 1.0);
    }
    CHECK(graph.at(100.0).pose);
    graph.wrist(14.0, 1.0);
    CHECK(isAt(graph.at(14.0), {1.0, 0.5, 1.0}));
}

TEST_CASE("A second publisher of a frame is ignored, and a frame may get another parent") {
    Graph graph;
    const Listening log;
    graph.fixed();
    graph.wrist(1.0, 0.0);
    const LiveNode other{2};
    graph.says(1.1, "arm", "wrist", {{9.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, false, other);
    graph.says(1.1, "base", "arm2", {}, false, other); // its own frames count
    graph.wrist(1.2, 0.0);
    CHECK(isAt(graph.at(1.1), {0.0, 0.5, 1.0}));
    CHECK(log.count("/tf of 'wrist' has a second publisher") == 1);
    graph.says(1.3, "arm2", "wrist", {{3.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    graph.says(1.3, "base", "arm2", {}, false, other);
    CHECK(isAt(graph.at(1.3), {3.0, 0.5, 0.0}));
}

TEST_CASE("Unusable transforms are skipped, counted and named once, and loops end") {
    Graph graph;
    const Listening log;
    graph.fixed();
    graph.wrist(1.0, 0.0);
    const double nan = std::nan("");
    for (int i = 0; i < 3; ++i) {
        graph.wrist(1.1, nan);
        graph.says(1.1, "arm", "wrist", {{}, {0.0, 0.0, 0.0, 0.0}});
        graph.says(1.1, "wrist", "wrist", {});
        graph.says(1.1, "", "wrist", {});
        graph.says(1.1, std::string(300, 'x'), "wrist", {});
        graph.transforms.take(LiveNode().sends({0, 1, 0, 0, 1, 0, 0, 0, 5, 0}, 1.1), false);
        graph.transforms.take(LiveNode().sends({0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff}, 1.1), true);
    }
    CHECK(graph.transforms.skipped() == 21);
    CHECK(log.count("message skipped") == 2);
    CHECK(log.count("transform skipped") == 3);
    for (const char* cause :
         {"the pose of frame 'wrist' is not finite", "frame 'wrist' is its own parent",
          "a frame's name has no or over 256 bytes", "truncated", "4294967295 transforms in one message"}) {
        CHECK_MESSAGE(log.count(cause) == 1, cause);
    }
    CHECK(graph.fault(1.1, true) == "/tf of 'wrist' ends before it");
    graph.says(1.2, "camera", "base", {});
    CHECK(graph.transforms.pose("camera", "elsewhere", LiveNode::kUtc + 1.2).why ==
          "no transforms between 'camera' and 'elsewhere'");
    for (size_t i = 0; i < 2 * LiveTransforms::kMaxFrames; ++i) {
        graph.says(2.0, "base", "f" + std::to_string(i), {});
    }
    CHECK(log.count("over 1000 frames") == 1);
}

TEST_CASE("An unusable transform does not take the others of its message with it") {
    Graph graph;
    graph.fixed();
    CdrWriter both;
    both.value(uint32_t{2});
    for (const auto& [child, x] : {std::pair("other", std::nan("")), std::pair("wrist", 0.25)}) {
        both.value(static_cast<uint32_t>(LiveNode::kUtc + 1.0));
        both.value(uint32_t{0});
        both.text("arm");
        both.text(child);
        for (const double value : {x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) {
            both.value(value);
        }
    }
    graph.transforms.take(LiveNode().sends(both.bytes(), 1.0), false);
    CHECK(graph.transforms.skipped() == 1);
    CHECK(isAt(graph.at(1.0), {0.25, 0.5, 1.0}));
}

TEST_CASE("Images wait in their order for the transforms at their stamps, and not for ever") {
    Graph graph;
    MovingCamera camera("test", "base");
    const auto says = [&](double stamp, const char* parent, const char* child, double x, bool isStatic) {
        camera.transforms().take(
            LiveNode().sends(ros2::transform({LiveNode::nanoseconds(stamp), ""},
                                             {parent, child, {{x, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}}),
                             stamp),
            isStatic);
    };
    CHECK(camera.follow("/camera") == "no transforms between 'camera' and 'base'");
    says(0.0, "wrist", "camera", 0.0, true);
    says(1.0, "base", "wrist", 0.0, false);
    CHECK(camera.follow("/camera") == "");
    camera.add(pairAt(1.05, 1.06));
    camera.add(pairAt(1.08, 1.09));
    CHECK_FALSE(camera.next(LiveNode::kBoot + 1.1));
    CHECK(camera.waits());
    says(1.07, "base", "wrist", 0.7, false);
    const auto first = camera.next(LiveNode::kBoot + 1.1);
    REQUIRE(first);
    CHECK(first->fixedTcamera->position.x == doctest::Approx(0.5));
    CHECK(first->fault.empty());
    CHECK_FALSE(camera.next(LiveNode::kBoot + 1.1));
    const auto second = camera.next(LiveNode::kBoot + 1.09 + MovingCamera::kPatience);
    REQUIRE(second);
    CHECK_FALSE(second->fixedTcamera);
    CHECK(second->fault == "no pose at its stamp: /tf of 'wrist' ends before it");
    CHECK_FALSE(camera.waits());
}
