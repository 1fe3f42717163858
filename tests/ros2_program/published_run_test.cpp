// SPDX-License-Identifier: Apache-2.0
// The whole program with topics of ROS 2, in real time.
#include "tests/rig/stage.h"
#include "tests/ros2/client.h"
#include "tests/ros2/topic_listener.h"
#include "tests/support/eventually.h"

#include <csignal>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <set>
#include <thread>
#include <utility>

using namespace fathom;
using nlohmann::json;

namespace {

const PixelBox kWhole{0, 0, kWidth, kHeight};

void redWall(Stage& stage) {
    stage.recording(std::vector<Image>(3, Image(kWidth, kHeight, 600).paint(kWhole, kRed)));
    SceneText scene;
    scene.hand = "path: press.csv";
    stage.scene(scene);
    stage.write("press.csv", handCsv({{0.0, {0, 0, 0.5}}, {1.0, {0, 0, 0.56}}, {8.0, {0, 0, 0.56}}}));
}

std::string inDomain(const std::string& request) {
    return request + ",domain=" + std::to_string(testDomain());
}

// A child of the program that ends with this.
class Started {
public:
    explicit Started(const std::vector<std::string>& arguments)
        : process_(startFathom(arguments)) {}
    ~Started() { end(); }
    int end() {
        if (process_ > 0) {
            code_ = exitCodeOf(std::exchange(process_, 0), SIGINT);
        }
        return code_;
    }

private:
    pid_t process_;
    int code_ = 0;
};

// The newest whole line of a state file; null when there is none yet.
json newestState(const Stage& stage) {
    const std::string text = std::filesystem::exists(stage / "state") ? stage.read("state") : "";
    const size_t end = text.rfind('\n');
    if (end == std::string::npos || end == 0) {
        return nullptr;
    }
    const size_t from = text.rfind('\n', end - 1);
    return json::parse(text.substr(from == std::string::npos ? 0 : from + 1, end - (from + 1)));
}

bool becomes(const Stage& stage, const std::function<bool(const json&)>& wanted) {
    return fathom::testing::eventually([&] {
        const json state = newestState(stage);
        return !state.is_null() && wanted(state);
    });
}

} // namespace

TEST_CASE("A realtime replay publishes the ticks that it writes to its files") {
    Stage stage;
    redWall(stage);
    TopicListener wrench("/arm/wrench", "WrenchStamped"), tool("/arm/tool_pose", "PoseStamped"),
        cloud("/arm/regions", "PointCloud2");
    const ProgramRun run = runFathom(stage.command({"--realtime", "--ros2", inDomain("/arm")}));
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    const Replay replay = readReplay(stage / "out", run);
    std::set<double> forces, places;
    for (const Tick& tick : replay.ticks) {
        forces.insert(tick.force.z);
        places.insert(tick.tool.position.z);
    }
    const auto among = [](const std::set<double>& all, double value) {
        const auto next = all.lower_bound(value - 1e-6);
        return next != all.end() && *next < value + 1e-6;
    };
    const Line pressed = wrench.until([](const Line& line) { return line.number(4) < -0.1; });
    REQUIRE(pressed.any());
    CHECK(among(forces, pressed.number(4)));
    for (int i = 0; i < 50; ++i) {
        CHECK(among(places, tool.next().number(4)));
    }
    CHECK(cloud.next().number(3) > 100.0); // points
}

TEST_CASE("A node of ROS 2 drives a replay through its bridge, and feels the wall") {
    Stage stage;
    redWall(stage);
    const std::string door = (stage / "hand.door").string();
    Started bridge(
        {"guard", "ros2", "--topics", inDomain("pose=/haptic/pose,preset=falcon"), "--door", door});
    TopicListener force("/haptic/wrench", "WrenchStamped");
    Peer node(ROS2_SPEAKER, {std::to_string(testDomain()), "/haptic/pose", "PoseStamped"});
    REQUIRE(node.line() == "ready");
    std::atomic<bool> stop{false}, press{false};
    std::thread moves([&] { // by 90 mm in 1 s
        for (double z = 0.0; !stop; z = std::min(0.09, z + (press ? 0.0002 : 0.0))) {
            node.send("0 0 " + std::to_string(z) + " 0 0 0 1");
            node.line();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    });
    REQUIRE(force.next().any()); // the bridge runs
    TopicListener tool("/fathom/tool_pose", "PoseStamped");
    Started engine(stage.command(
        {"--realtime", "--hand-device", door, "--ros2", inDomain("/fathom"), "--seconds", "60"}));
    CHECK(tool.next().is("base 0 0 0.5 0 0 0 1"));
    press = true;
    CHECK(force.until([](const Line& line) { return line.number(4) < -1.0; }).any());
    CHECK(engine.end() == 0);
    CHECK(force.until([](const Line& line) { return line.number(4) == 0.0; }).any());
    stop = true;
    moves.join();
    CHECK(bridge.end() == 0);
}

TEST_CASE("Another program switches the window's forces off, and freezes its fixtures") {
    Stage stage;
    redWall(stage);
    Started window({"operate", (stage / "scene.yaml").string(), "--source", (stage / "rec").string(),
                    "--device", "llvmpipe", "--offscreen", "640x480", "--path", "--ros2",
                    inDomain("/fathom,commands=on"), "--state", (stage / "state").string()});
    REQUIRE(becomes(stage, [](const json& state) { return state["console"]["forces"] == true; }));
    Peer off(ROS2_SPEAKER, {std::to_string(testDomain()), "/fathom/forces_off", "Empty"}),
        freeze(ROS2_SPEAKER, {std::to_string(testDomain()), "/fathom/freeze", "Bool"});
    REQUIRE(off.line() == "ready");
    REQUIRE(freeze.line() == "ready");
    CHECK(becomes(stage, [&](const json& state) {
        off.send(""); // until it is matched
        off.line();
        return state["console"]["forces"] == false;
    }));
    CHECK(becomes(stage, [&](const json& state) {
        freeze.send("1");
        freeze.line();
        return state["console"]["frozen"] == true;
    }));
    CHECK(newestState(stage)["console"]["forces"] == false);
    Client release("/fathom/freeze", "SetBool");
    CHECK(release.call("0") == "1 1 fixtures are released");
    CHECK(becomes(stage, [](const json& state) { return state["console"]["frozen"] == false; }));
    CHECK(window.end() == 0);
}

TEST_CASE("Topics without a realtime run, requests to a replay and a wrong preset are rejected in one line") {
    Stage stage;
    redWall(stage);
    const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
        const ProgramRun run = runFathom(arguments);
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK_MESSAGE(run.errorLines()[0].find(part) != std::string::npos, run.errorLines()[0]);
    };
    refused(stage.command({"--ros2", "/fathom"}), "--ros2: /fathom (allowed: together with --realtime)");
    refused(stage.command({"--realtime", "--ros2", "/fathom,commands=on"}), "commands=on only with operate");
    refused(stage.command({"--realtime", "--ros2", "/fathom,rate=x"}), "--ros2: rate: x");
    refused(stage.command({"--realtime", "--ros2", inDomain("/fathom,trajectory=/a,measured=/b")}),
            "only with a scene that has an arm");
    refused({"guard", "ros2", "--topics", "pose=/p,preset=nothing", "--door", (stage / "d").string()},
            "'nothing'");
}
