// SPDX-License-Identifier: Apache-2.0
// `operate --arm PORT`: the pilot drives a simulated arm on a serial line, sees it, and sees its faults.
#include "tests/rig/arm_stage.h"
#include "tests/window/window_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;
using namespace fathom::window;
using nlohmann::json;

namespace {

constexpr double kSurface = 0.54; // [m] z of the tip's ball centre in contact with the region

double apart(const std::array<double, 3>& a, const std::array<double, 3>& b) { // [rad]
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// The window on the stage's scene, with a simulated arm on the line.
struct ArmWindow {
    Stage stage;
    ReachSimulator arm;
    std::unique_ptr<ArmBench> bench;
    WindowRig rig;

    explicit ArmWindow(const std::string& more = {}) {
        setUp(stage, kReach, pushing(4.5));
        stage.write("scene.yaml", stage.read("scene.yaml") + more);
        setStart(arm);
        bench = std::make_unique<ArmBench>(arm, stage / "line");
        rig.reopen(stage / "scene.yaml",
                   {"--source", (stage / "rec").string(), "--arm", (stage / "line").string()});
    }
    std::array<double, 3> joints() {
        return bench->with([this] { return jointsOf(arm); });
    }
    double depth() { return tipDepth(joints()); }
    void arms() {
        rig.key("a");
        REQUIRE(
            rig.await([](const json& s) { return s["mode"] == "ARMED" && s["run"]["arm"] == "follows"; }));
    }
    // Drives the tip towards the wall or back until the arm meets the condition.
    void drive(const char* key, const std::function<bool(double depth)>& there) {
        rig.keyDown(key);
        CHECK(bench->wait([&] { return there(tipDepth(jointsOf(arm))); }));
        rig.keyUp(key);
    }
    bool await(const std::function<bool(const json& run)>& wanted) {
        return rig.await([&](const json& s) { return wanted(s["run"]); });
    }
    // Drives towards the wall until the force [N] is reached.
    void push(double force) {
        rig.keyDown("Page_Up");
        CHECK(await([&](const json& run) { return run["force_N"] > force && run["arm"] == "follows"; }));
        rig.keyUp("Page_Up");
    }
    // Checks that the window shows the posture of the simulator, once the arm is at rest.
    void meets() {
        CHECK(await([&](const json& run) {
            const json& measured = run["real_arm"]["measured"];
            const auto q = joints();
            return measured.is_array() && apart(measured.get<std::array<double, 3>>(), q) < 1e-4 &&
                   std::abs(run["tool"][2].get<double>() - tipDepth(q)) < 0.002;
        }));
    }
    void close() {
        const int code = rig.close();
        CHECK_MESSAGE(code == 0, rig.output());
    }
};

bool warns(const json& s, const char* words) {
    const json& alarms = s["alarms"];
    return std::any_of(alarms.begin(), alarms.end(), [&](const json& a) { return a == words; });
}

bool isMeasured(int r, int g, int b) { // the colour of the measured arm
    return r > 180 && b > 150 && g < 160 && r - g > 70 && b - g > 50;
}

} // namespace

TEST_CASE("Keys drive an arm to a region and back; forces off hold it, and closing the window stops it") {
    ArmWindow w;
    REQUIRE(w.await([](const json& run) { return run["arm"] == "held" && run["turns"] > 100; }));
    w.meets();
    const auto start = w.joints();
    w.arms();
    w.push(2.0);
    w.meets();
    CHECK(w.depth() < kSurface + 0.001);
    CHECK(w.depth() > tipDepth(start) + 0.05);
    w.drive("Page_Down", [](double depth) { return depth < kSurface - 0.03; });
    w.rig.key("space");
    REQUIRE(w.await([](const json& run) { return run["arm"] == "held" && run["force_N"] == 0.0; }));
    w.meets();
    const auto held = w.joints();
    w.rig.keyDown("Page_Up"); // does not move the arm
    const auto ticks = w.rig.state()["run"]["turns"].get<int>();
    REQUIRE(w.await([&](const json& run) { return run["turns"] > ticks + 500; }));
    w.rig.keyUp("Page_Up");
    CHECK(apart(w.joints(), held) < 1e-4);
    w.arms();
    w.rig.keyDown("Page_Up");
    CHECK(w.bench->wait([&] { return tipDepth(jointsOf(w.arm)) > tipDepth(held) + 0.01; }));
    w.close(); // while it moves
    const auto last = w.joints();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(w.joints() == last);
}

TEST_CASE("When an arm falls silent or is unplugged, the force goes to zero, the window reports it, and both "
          "resume when it is back") {
    for (const bool unplugged : {false, true}) {
        CAPTURE(unplugged);
        ArmWindow w;
        w.arms();
        w.push(1.0);
        const char* state = unplugged ? "gone" : "silent";
        if (unplugged) {
            w.bench->unplug();
        } else {
            LineFaults cut;
            cut.cut = true;
            w.bench->faults(cut);
        }
        REQUIRE(w.rig.await([&](const json& s) {
            return s["run"]["arm"] == state && s["run"]["force_N"] == 0.0 && warns(s, "WARNING active arm");
        }));
        CHECK(w.rig.state()["run"]["real_arm"]["measured"].is_null());
        const auto still = w.joints();
        w.rig.keyDown("Page_Down"); // moves neither tool nor arm
        const json before = w.rig.state()["run"];
        REQUIRE(w.await([&](const json& run) { return run["turns"] > before["turns"].get<int>() + 300; }));
        w.rig.keyUp("Page_Down");
        CHECK(w.rig.state()["run"]["tool"] == before["tool"]);
        CHECK(apart(w.joints(), still) < 1e-4);
        unplugged ? w.bench->plug() : w.bench->faults({});
        REQUIRE(w.rig.await(
            [&](const json& s) { return s["run"]["arm"] == "follows" && warns(s, "WARNING latched arm"); }));
        w.drive("Page_Down", [&](double depth) { return depth < tipDepth(still) - 0.02; });
        w.meets();
        w.close();
    }
}

TEST_CASE("Another pilot takes over a real arm at its present posture") {
    ArmWindow w("pilots:\n  - {name: anna, stiffness: 300}\n  - {name: ben, stiffness: 150}\n");
    w.rig.click("pilot anna");
    REQUIRE(
        w.rig.await([](const json& s) { return s["pilot"]["name"] == "anna" && s["run"]["turns"] > 100; }));
    w.arms();
    w.drive("Page_Up", [](double depth) { return depth > kSurface - 0.05; });
    w.meets();
    const auto before = w.joints();
    w.rig.click("pilot ben");
    REQUIRE(
        w.rig.await([](const json& s) { return s["pilot"]["name"] == "ben" && s["run"]["turns"] > 100; }));
    CHECK(apart(w.joints(), before) < 0.002); // it is at rest
    w.meets();
    w.arms();
    w.drive("Page_Down", [&](double depth) { return depth < tipDepth(before) - 0.02; });
    w.close();
}

TEST_CASE("An arm off its setpoint is drawn and labelled in both views, an arm at its setpoint is not") {
    ArmWindow w;
    w.arms();
    w.meets();
    REQUIRE(w.await([](const json& run) { return run["real_arm"]["drawn"] == false; }));
    const Screenshot near = w.rig.shoot("arm-near");
    for (const char* view : {"camera", "space"}) {
        CHECK(near.share(w.rig.place(view), isMeasured) < 1e-4);
    }
    w.bench->with([&] { w.arm.speed.fill(0.01); });
    w.rig.keyDown("Page_Up");
    const auto behind = [](const json& run) {
        const json& arm = run["real_arm"];
        return arm["drawn"] == true && arm["apart_m"] > 0.02 && std::abs(arm["error"].get<double>()) > 0.03;
    };
    REQUIRE(w.await(behind));
    w.rig.keyUp("Page_Up");
    REQUIRE(w.await(behind));
    const Screenshot far = w.rig.shoot("arm-behind");
    for (const char* view : {"camera", "space"}) {
        CAPTURE(view);
        CHECK(far.share(w.rig.place(view), isMeasured) > 5e-4);
    }
    CHECK(far.share(w.rig.place("head arm"), isMeasured) > 0.01);
    w.close();
}
