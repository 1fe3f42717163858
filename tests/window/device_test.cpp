// SPDX-License-Identifier: Apache-2.0
// The window driven by a haptic device instead of mouse and keyboard.
#include "tests/rig/played_device.h"
#include "tests/rig/run_fathom.h"
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>
#include <optional>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

double z(const json& s, const char* what) {
    return s["run"][what][2];
}

// Presses until the tool is in contact and the hand feels it.
bool pressUntilFelt(const WindowRig& rig, PlayedDevice& device) {
    for (int tries = 0; tries < 20; ++tries) {
        // Requires a contact, because a force alone may come from a tool that is still catching up.
        const bool felt = rig.state()["run"]["contacts"] > 0 && device.feels(-8.0, -0.2, 2000);
        const json state = rig.state();
        if (felt && z(state, "device") > z(state, "tool") + 0.0005) {
            return true;
        }
        device.push(device.z + 0.03);
    }
    return false;
}

} // namespace

TEST_CASE("A haptic device on its socket drives the tool in the window and feels the region; the space bar "
          "turns forces off") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    const double start = z(rig.state(), "tool");
    const auto endpoint = rig.folder() / "hand.door";
    PlayedDevice device(endpoint);
    device.z = 0.15; // the tool starts in the same place for any handle pose
    rig.reopen(rig.folder() / "scene.yaml", {"--hand-device", endpoint.string()});
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 200; }));
    CHECK(rig.state()["hand"]["name"].get<std::string>().find("played device") == 0);
    CHECK(rig.state()["hand"]["there"] == true);
    CHECK(z(rig.state(), "tool") == doctest::Approx(start).epsilon(1e-6));
    device.push(0.17);
    REQUIRE(
        rig.await([&](const json& s) { return z(s, "tool") > start + 0.015; })); // forces are off, it moves
    CHECK(device.fz == 0.0);
    rig.keyDown("Up"); // keys do not move the tool while a device does
    rig.keyUp("Up");
    const json rests = rig.atRest();
    REQUIRE(!rests.is_null());
    CHECK(z(rests, "device") == doctest::Approx(start + 0.02).epsilon(0.01));
    CHECK(rests["run"]["device"][1].get<double>() == doctest::Approx(rests["run"]["tool"][1].get<double>()));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    REQUIRE(pressUntilFelt(rig, device));
    REQUIRE(!rig.atRest().is_null());
    CHECK(z(rig.state(), "device") > z(rig.state(), "tool") + 0.0005);
    rig.shoot("device");
    rig.key("space");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == false; }));
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 2500; })); // soft start over
    CHECK(device.fz == 0.0);
    CHECK(rig.state()["run"]["force_N"] == 0.0);
    CHECK(rig.close() == 0);
    CHECK(rig.output().find("validation") == std::string::npos);
}

TEST_CASE("A haptic device that disconnects loses its force, is reported, and resumes where the tool is") {
    WindowRig rig;
    const auto endpoint = rig.folder() / "hand.door";
    std::optional<PlayedDevice> device;
    device.emplace(endpoint);
    rig.reopen(rig.folder() / "scene.yaml", {"--hand-device", endpoint.string()});
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    REQUIRE(pressUntilFelt(rig, *device));
    const double tool = z(rig.state(), "tool");
    device.reset();
    REQUIRE(rig.await([](const json& s) {
        return s["hand"]["there"] == false && hasAlarm(s, "WARNING active hand") &&
               s["run"]["force_N"] == 0.0;
    }));
    rig.shoot("device-gone");
    device.emplace(endpoint); // the handle is far from its earlier place
    REQUIRE(rig.await([](const json& s) { return s["hand"]["there"] == true; }));
    CHECK(rig.await([](const json& s) { return hasAlarm(s, "WARNING latched hand"); }));
    CHECK(z(rig.state(), "tool") == doctest::Approx(tool).epsilon(0.005));
    REQUIRE(pressUntilFelt(rig, *device)); // the pilot has not turned forces off
    rig.key("q");
    CHECK(rig.await([](const json& s) { return !hasAlarm(s, "hand"); }));
    CHECK(rig.close() == 0);
}

TEST_CASE("A missing haptic device, or one given with a recording, is rejected in one line") {
    WindowRig rig;
    CHECK(rig.close() == 0);
    const auto scene = rig.folder() / "scene.yaml";
    for (const auto& [more, words] :
         {std::pair(std::vector<std::string>{"--hand-device", "/none/hand.door"}, "socket: /none/hand.door"),
          std::pair(std::vector<std::string>{"--hand-device", "/none/hand.door", "--recording", "."},
                    "--hand-device: /none/hand.door (allowed: nothing beside a recording)")}) {
        std::vector<std::string> arguments{"operate", scene.string(), "--offscreen", "640x480"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramRun run = runFathom(arguments);
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK_MESSAGE(run.errorLines()[0].find(words) != std::string::npos, run.errorLines()[0]);
    }
}

TEST_CASE("A button is mapped by pressing it, is saved next to the scene, and a button in use is refused") {
    WindowRig rig;
    const auto endpoint = rig.folder() / "hand.door";
    PlayedDevice device(endpoint);
    rig.reopen(rig.folder() / "scene.yaml", {"--hand-device", endpoint.string()});
    rig.key("F4");
    REQUIRE(rig.await([](const json& s) { return s["console"]["places"].contains("map guidance"); }));
    CHECK(rig.state()["hand"]["buttons"]["guidance"] == 1);
    const auto press = [&](const char* use, uint32_t bit) {
        rig.click(std::string("map ") + use);
        REQUIRE(rig.await([&](const json& s) { return s["hand"]["mapping"] == use; }));
        device.buttons = bit;
        REQUIRE(rig.await([](const json& s) { return s["hand"]["mapping"].is_null(); }));
        CHECK(rig.state()["run"]["guidance_w"] == 0.0); // it does nothing while it is mapped
        device.buttons = 0;
        REQUIRE(rig.await([](const json& s) { return s["hand"]["held"] == 0; }));
    };
    press("guidance", 16);
    REQUIRE(rig.awaitNotice("guidance is button 5, saved to"));
    CHECK(rig.state()["hand"]["buttons"]["guidance"] == 16);
    press("clutch", 16);
    REQUIRE(rig.awaitNotice("button 5 is guidance already"));
    CHECK(rig.state()["hand"]["buttons"]["clutch"] == 4);
    rig.shoot("device-tab");
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    device.buttons = 1; // the old button of guidance
    REQUIRE(rig.await([](const json& s) { return s["hand"]["held"] == 1; }));
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 200; }));
    CHECK(rig.state()["run"]["guidance_w"] == 0.0);
    device.buttons = 16;
    CHECK(rig.await([](const json& s) { return s["run"]["guidance_w"] > 0.0; }));
    device.buttons = 0;
    rig.reopen(rig.folder() / "scene.yaml", {"--hand-device", endpoint.string()});
    CHECK(rig.state()["hand"]["buttons"]["guidance"] == 16);
    closeQuietly(rig);
}
