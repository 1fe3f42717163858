// SPDX-License-Identifier: Apache-2.0
// Topics of a run. Their subscribers are processes of another program (tests/ros2_listener). Waits have
// generous limits, and none is for a fixed time.
#include "apps/binding/ros2_output.h"
#include "tests/ros2/fed_run.h"
#include "tests/ros2/topic_listener.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

std::string outputRefusal(const std::string& text) {
    return testing::refusalOf([&] { parseRos2OutputRequest(text); });
}

} // namespace

TEST_CASE("Wrenches and poses of a run arrive at subscribers with their frames and UTC stamps") {
    FedRun run("/fathom,frame=base_link");
    TopicListener wrench("/fathom/wrench", "WrenchStamped"), device("/fathom/device_wrench", "WrenchStamped"),
        tool("/fathom/tool_pose", "PoseStamped"), hand("/fathom/device_pose", "PoseStamped"),
        target("/fathom/target_pose", "PoseStamped");
    CHECK(wrench.next().is("base_link 1 2 3 0.1 0.2 0.3"));
    CHECK(device.next().is("fathom_device -1 0 0.5 0 0 0"));
    CHECK(tool.next().is("base_link 0.25 -0.5 0.75 0.5 0.5 0.5 0.5"));
    CHECK(hand.next().is("base_link 0.25 -0.5 0.7 0 0 0 1"));
    CHECK(target.next().is("base_link 0 0 0.8 0 0 0 1"));
    double last = 0.0;
    for (int i = 0; i < 20; ++i) {
        const double stamp = wrench.next().stamp();
        CHECK(stamp > last);
        CHECK(std::abs(stamp - utcNow()) < 30.0);
        last = stamp;
    }
}

TEST_CASE("No target is published while nothing guides") {
    FedRun run("/fathom");
    run.change([](TickRow& row) { row.record.guidanceClass = -1; });
    TopicListener target("/fathom/target_pose", "PoseStamped"), tool("/fathom/tool_pose", "PoseStamped");
    for (int i = 0; i < 50; ++i) {
        REQUIRE(tool.next().any());
    }
    CHECK_FALSE(target.waiting());
    run.change([](TickRow& row) { row.record.guidanceClass = 0; });
    CHECK(target.next().any());
}

TEST_CASE("Regions and shapes are published as points and as markers, also to who subscribes later") {
    FedRun run("/fathom");
    TopicListener cloud("/fathom/regions", "PointCloud2"), markers("/fathom/markers", "MarkerArray");
    CHECK(cloud.next().is("base x,y,z,radius,class 3 1 20 60 10.5 -0.25 1 0.0625 2"));
    CHECK(markers.next().is("base - 0 2 3 0 0 0 0 0 0 1 1 1 1 0 0 - 0")); // deletes those of before
    const Line small = markers.next(), large = markers.next(), box = markers.next(), axis = markers.next();
    constexpr size_t kDiameter = 14, kPoints = 18;
    CHECK(small.words(1, 6) == "base class 2 -29 7 0");
    CHECK(small.number(kDiameter) >= 0.125);
    CHECK(small.number(kDiameter) < 0.125 * 1.101);
    CHECK(small.number(kPoints) == 2.0);
    CHECK(large.number(kDiameter) >= 0.25);
    CHECK(large.number(kPoints) == 1.0);
    CHECK(box.is("base shapes 4 1 0 0.1 0.2 0.3 0 0 0 1 0.5 0.6 0.7 0.25 0 - 0"));
    CHECK(axis.words(1, 5) == "base shapes 5 0 0");
    TopicListener late("/fathom/regions", "PointCloud2");
    CHECK(late.next().any());
}

TEST_CASE("Diagnostics name the state, the age of the scene, the rates, and a fault of the arm") {
    FedRun run("/fathom");
    run.change([](TickRow& row) {
        row.record.state = StepState::Trapped;
        row.record.sceneAge = 0.25;
        row.driven = true;
        row.armStatus.state = ArmState::Overloaded;
    });
    TopicListener diagnostics("/diagnostics", "DiagnosticArray");
    const auto part = [&](const std::string& name) {
        return diagnostics.until([&](const Line& line) { return line.holds(name); });
    };
    const Line forces = part("fathom: forces");
    CHECK(forces.holds(" 2 fathom: forces trapped "));
    CHECK(forces.holds("force_n=3.742"));
    CHECK(part("fathom: camera")
              .holds(" 1 fathom: camera the newest frame is too old sets_per_s=0 scene_age_s=0.25"));
    CHECK(part("fathom: arm").holds(" 2 fathom: arm overloaded "));
    CHECK(diagnostics.until([](const Line& line) { return line.holds("ticks_per_s=1000"); }).any());
}

TEST_CASE("The joints of an arm are published with their names") {
    FedRun run("/fathom", {{"shoulder", false}, {"elbow", false}});
    TopicListener joints("/fathom/joint_states", "JointState");
    CHECK(joints.next().is("base shoulder 0.5 elbow -0.25"));
}

TEST_CASE("A subscriber that stops reading, and one that is killed, do not keep messages from others") {
    FedRun run("/fathom");
    TopicListener wrench("/fathom/wrench", "WrenchStamped");
    auto killed = std::make_unique<TopicListener>("/fathom/wrench", "WrenchStamped");
    TopicListener stopped("/fathom/wrench", "WrenchStamped");
    REQUIRE(killed->next().any());
    REQUIRE(stopped.next().any());
    stopped.stop();
    killed.reset();
    run.change([](TickRow& row) { row.record.wrench.force.x = 7.0; });
    CHECK(wrench.until([](const Line& line) { return line.number(2) == 7.0; }).any());
    const double from = run.time();
    CHECK(wrench.until([&](const Line&) { return run.time() > from + 2.0; }).any());
    run.change([](TickRow& row) { row.record.wrench.force.x = 8.0; });
    CHECK(wrench.until([](const Line& line) { return line.number(2) == 8.0; }).any());
}

TEST_CASE("A topic gets at most the rate that was asked for, and a new run continues it") {
    FedRun run("/fathom,rate=20");
    TopicListener tool("/fathom/tool_pose", "PoseStamped");
    REQUIRE(tool.next().any());
    double last = tool.next().stamp();
    for (int i = 0; i < 10; ++i) {
        const double stamp = tool.next().stamp();
        CHECK(stamp - last > 0.045);
        last = stamp;
    }
    run.restart();
    CHECK(tool.until([&](const Line& line) { return line.stamp() > last + 0.2; }).any());
}

TEST_CASE("Another network than the one in use is refused, and so are words that are not known") {
    FedRun run("/fathom");
    const auto other = parseRos2OutputRequest("/fathom,domain=" + std::to_string(testDomain() + 1));
    CHECK(testing::refusalOf([&] { openRos2Output(other, {}); }).find("which this program uses already") !=
          std::string::npos);
    CHECK(outputRefusal("/fathom,colour=red").find("--ros2: colour: red (allowed: /PREFIX") == 0);
    CHECK(outputRefusal("/fathom,rate=0").find("--ros2: rate: 0 (allowed: a number above 0") == 0);
    CHECK(outputRefusal("/fathom,rate=1001") != "");
    CHECK(outputRefusal("/fathom,frame=a b").find("--ros2: frame: a b") == 0);
    CHECK(outputRefusal("/fa thom").find("--ros2: PREFIX: /fa thom") == 0);
    CHECK(outputRefusal("/fathom,network=lo,domain=233").find("--ros2: domain: 233") == 0);
    CHECK(parseRos2OutputRequest("hand").prefix == "/hand");
}
