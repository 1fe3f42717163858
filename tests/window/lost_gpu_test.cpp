// SPDX-License-Identifier: Apache-2.0
// Loss of the GPU in the passes or the painter, simulated by a Vulkan layer: hand and keys keep working, and
// the state is restored when the GPU is back.
#include "tests/rig/losing.h"
#include "tests/rig/run_fathom.h"
#include "tests/window/window_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

constexpr int kNever = 1000000;

struct LosingRig {
    // refused: number of attempts to open a device that fail after each loss.
    explicit LosingRig(int refused)
        : losing(trigger(), refused) {}

    std::string trigger() const { return (folder.path() / "lose").string(); }
    // Loses the device at the next call of this kind (tests/losing_layer).
    void ask(const std::string& call) const {
        folder.write("word", call);
        std::filesystem::rename(folder.path() / "word", trigger());
    }
    void lose(const std::string& call) const {
        ask(call);
        REQUIRE(window.await([&](const json&) { return !std::filesystem::exists(trigger()); }));
        REQUIRE(window.await([](const json& s) { return s["gpu"]["there"] == false; }));
    }
    bool awaitBack(int madeAnew) const {
        return window.await(
            [&](const json& s) { return s["gpu"]["there"] == true && s["gpu"]["made_anew"] == madeAnew; });
    }
    // The states since that of `tick`.
    std::vector<json> since(const json& tick) const {
        std::vector<json> states;
        std::ifstream in(window.folder() / "state.jsonl");
        for (std::string line; std::getline(in, line) && !in.eof();) {
            states.push_back(json::parse(line));
        }
        std::erase_if(states, [&](const json& s) { return s["run"]["turns"] <= tick; });
        return states;
    }

    TemporaryFolder folder;
    Losing losing;
    WindowRig window;
};

double force(const json& s) {
    return s["run"]["force_N"];
}

// Arms forces and pushes the tool against the bump with the wheel.
void press(const WindowRig& rig) {
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["run"]["contacts"] > 0 && force(s) > 1.0; }));
    REQUIRE(!rig.atRest().is_null());
}

// Checks the states without a GPU: ticks continue, the force is zero 0.5 s after the frame is too old, and
// the tool stays outside the last regions.
void checkGone(const std::vector<json>& states, const json& before) {
    std::vector<json> gone;
    std::copy_if(states.begin(), states.end(), std::back_inserter(gone),
                 [](const json& s) { return s["gpu"]["there"] == false; });
    REQUIRE(gone.size() > 8);
    const int ticks = gone.back()["run"]["turns"].get<int>() - gone.front()["run"]["turns"].get<int>();
    CHECK(ticks > 300);
    for (size_t i = 0; i < gone.size(); ++i) {
        CAPTURE(i);
        const double age = gone[i]["run"]["scene_age_s"];
        CHECK((age < 0.65 || force(gone[i]) == 0.0));
        CHECK(std::abs(gone[i]["run"]["tool"][2].get<double>() - before["run"]["tool"][2].get<double>()) <
              0.001);
        CHECK((age < 0.25 || gone[i]["run"]["frame"] == gone.back()["run"]["frame"]));
    }
    CHECK(force(gone.back()) == 0.0);
    CHECK(hasAlarm(gone.back(), "WARNING active gpu"));
    CHECK_FALSE(hasAlarm(gone.back(), "camera"));
    CHECK(gone.back()["console"]["forces"] == before["console"]["forces"]);
}

void checkEnd(WindowRig& rig) {
    const int code = rig.close(); // 1: the validation layers reported something
    CHECK_MESSAGE(code == 0, rig.output());
    CHECK(rig.output().find("validation:") == std::string::npos);
}

} // namespace

TEST_CASE("A GPU lost in passes, painter or presentation is opened again while the force fades, and window, "
          "pilot's settings and recording continue") {
    LosingRig lost(3); // retries after 0.1, 0.2, 0.4 and 0.8 s, which takes longer than the fade
    const WindowRig& rig = lost.window;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    rig.click("hold red");
    REQUIRE(rig.await([](const json& s) { return s["fixtures"][0]["frozen"] == true; }));
    rig.click("place sphere");
    rig.click("camera", 0.2, 0.2);
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 1; }));
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == true; }));
    press(rig);
    const double red = rig.shoot("gpu-before").share(rig.place("camera"), isRed);
    int times = 0;
    for (const std::string call : {"passes", "drawing", "presenting"}) {
        CAPTURE(call);
        const json before = rig.state();
        lost.lose(call);
        REQUIRE(lost.awaitBack(++times));
        checkGone(lost.since(before["run"]["turns"]), before);
        REQUIRE(rig.await([&](const json& s) {
            return s["run"]["pictures"] > before["run"]["pictures"].get<int>() + 10 &&
                   s["window"]["frames"] > before["window"]["frames"].get<int>() + 10 &&
                   force(s) > 1.0; // late ticks soften the springs
        }));
        const json after = rig.state();
        CHECK(after["window"]["swapchains"] > before["window"]["swapchains"]);
        CHECK(after["fixtures"] == before["fixtures"]);
        CHECK(after["shapes"] == 1);
        CHECK(after["run"]["spheres"] == before["run"]["spheres"]); // still frozen
        CHECK(after["console"]["recording"] == true);
        CHECK(hasAlarm(after, "WARNING latched gpu"));
        rig.key("q");
        REQUIRE(rig.await([](const json& s) { return !hasAlarm(s, "gpu"); }));
        const double share = rig.shoot("gpu-after-" + call).share(rig.place("camera"), isRed);
        CHECK(share > 0.01);
        CHECK(share == doctest::Approx(red).epsilon(0.1));
    }
    rig.key("ctrl+z");
    CHECK(rig.await([](const json& s) { return s["shapes"] == 0; }));
    rig.key("ctrl+z");
    CHECK(rig.await([](const json& s) { return s["fixtures"][0]["frozen"] == false; }));
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == false; }));
    checkEnd(lost.window);
    CHECK(rig.output().find("lost and reopened 3 times") != std::string::npos);
    const ProgramRun replay = runFathom({"replay", (rig.folder() / "recording-1" / "scene.yaml").string(),
                                         "--source", (rig.folder() / "recording-1").string(), "--device",
                                         "llvmpipe", "--out", (rig.folder() / "again").string()});
    CHECK_MESSAGE(replay.exitCode == 0, replay.err);
}

TEST_CASE("Forces that are off stay off when the GPU is lost, and the space bar works without a GPU") {
    LosingRig lost(2);
    const WindowRig& rig = lost.window;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    const json off = rig.state();
    REQUIRE(off["console"]["forces"] == false);
    lost.lose("passes");
    REQUIRE(lost.awaitBack(1));
    REQUIRE(rig.await(
        [&](const json& s) { return s["run"]["pictures"] > off["run"]["pictures"].get<int>() + 10; }));
    for (const json& s : lost.since(off["run"]["turns"])) {
        CHECK(s["console"]["forces"] == false);
        CHECK(force(s) == 0.0);
    }
    press(rig);
    lost.lose("drawing");
    lost.ask("drawing"); // also fails the next device, while the window opens it
    rig.key("space");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == false; }));
    REQUIRE(lost.awaitBack(3));
    const json back = rig.state();
    REQUIRE(rig.await(
        [&](const json& s) { return s["run"]["pictures"] > back["run"]["pictures"].get<int>() + 10; }));
    CHECK(rig.state()["console"]["forces"] == false);
    CHECK(force(rig.state()) == 0.0);
    checkEnd(lost.window);
}

TEST_CASE(
    "A GPU that never comes back leaves hand, keys and an orderly end, and the window's title reports it") {
    LosingRig lost(kNever);
    const WindowRig& rig = lost.window;
    press(rig);
    lost.lose("presenting");
    REQUIRE(rig.await([](const json& s) { return force(s) == 0.0; }));
    rig.xdo("getwindowname $W");
    std::ifstream names(rig.folder() / "xdo.log");
    const std::string said{std::istreambuf_iterator<char>(names), {}};
    CHECK(said.find("GPU is gone") != std::string::npos);
    rig.key("F12");
    CHECK(rig.awaitNotice("no screenshot"));
    rig.key("space");
    CHECK(rig.await([](const json& s) { return s["console"]["forces"] == false; }));
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    CHECK(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 1000; }));
    checkEnd(lost.window);
    CHECK(rig.output().find("GPU is gone") != std::string::npos);
}

TEST_CASE("Another pilot takes over while there is no GPU, and gets forces when it is back") {
    LosingRig lost(8); // lasts some seconds, also into the new run
    WindowRig& rig = lost.window;
    const auto scene = rig.folder() / "pilots.yaml";
    std::ofstream(scene) << rig.sceneText()
                         << "\npilots:\n  - {name: anna, stiffness: 300}\n  - {name: ben}\n";
    rig.reopen(scene, {"--pilot", "ben"});
    press(rig);
    lost.lose("passes");
    REQUIRE(rig.await([](const json& s) { return s["run"]["scene_age_s"] > 0.7; })); // no longer a late frame
    rig.click("pilot anna");
    REQUIRE(rig.await([](const json& s) { return s["pilot"]["name"] == "anna" && s["run"]["turns"] > 100; }));
    CHECK(rig.state()["gpu"]["there"] == false);
    CHECK(rig.state()["console"]["forces"] == false);
    rig.key("f"); // the set from before remains
    REQUIRE(lost.awaitBack(1));
    REQUIRE(rig.await([](const json& s) { return s["run"]["pictures"] > 10; }));
    rig.key("f");
    REQUIRE(rig.await([](const json& s) { return s["run"]["pictures"] > 10 && s["run"]["turns"] > 100; }));
    CHECK(rig.state()["pilot"]["stiffness"] == doctest::Approx(300.0));
    press(rig);
    checkEnd(rig);
}

TEST_CASE("Playback returns after the loss of a GPU at the same moment") {
    LosingRig lost(1);
    WindowRig& rig = lost.window;
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == true; }));
    press(rig);
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == false; }));
    rig.reopen(rig.folder() / "recording-1");
    rig.click("time line", 0.8);
    REQUIRE(rig.await([](const json& s) { return s["console"]["time_line"]["t"] > 0.5; }));
    const json before = rig.state();
    const double red = rig.shoot("gpu-past-before").share(rig.place("camera"), isRed);
    int times = 0;
    for (const std::string call : {"drawing", "presenting"}) {
        CAPTURE(call);
        lost.lose(call);
        REQUIRE(lost.awaitBack(++times));
        const json after = rig.state();
        CHECK(after["console"]["time_line"]["t"] == before["console"]["time_line"]["t"]);
        REQUIRE(rig.await(
            [&](const json& s) { return s["window"]["frames"] > after["window"]["frames"].get<int>() + 5; }));
        CHECK(rig.state()["run"]["frame"] == before["run"]["frame"]);
        CHECK(rig.state()["run"]["spheres"] == before["run"]["spheres"]);
        CHECK(rig.shoot("gpu-past-" + call).share(rig.place("camera"), isRed) ==
              doctest::Approx(red).epsilon(0.1));
    }
    rig.key("Right"); // the next frame is processed on the new device
    CHECK(rig.await([&](const json& s) {
        return s["console"]["time_line"]["picture"] > before["console"]["time_line"]["picture"];
    }));
    checkEnd(rig);
}
