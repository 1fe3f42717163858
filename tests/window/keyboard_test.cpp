// SPDX-License-Identifier: Apache-2.0
// The window without a mouse: panels, colours and places by keys alone, and the priority of the space bar.
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

// The state some frames later, when keys have taken effect.
json later(const WindowRig& rig, int by = 4) {
    const auto frames = rig.state()["window"]["frames"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["window"]["frames"] > frames + by; }));
    return rig.state();
}

} // namespace

TEST_CASE("Forces armed and turned off within one frame are off, whatever the order of the keys") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    for (int i = 0; i < 6; ++i) {
        rig.xdo(i % 2 == 0 ? "key --delay 0 a a space" : "key --delay 0 g a space");
        const json s = later(rig);
        CHECK(s["console"]["forces"] == false);
        CHECK(s["console"]["guidance"] == false);
    }
    rig.key("a"); // without the space bar, it arms
    CHECK(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    closeQuietly(rig);
}

TEST_CASE("Key presses faster than the frame rate all count") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["console"]["tree_level"] == -1; }));
    rig.xdo("key --delay 50 t t t"); // [ms] a shorter delay would count as a held key
    CHECK(rig.await([](const json& s) { return s["console"]["tree_level"] == 2; }));
    rig.xdo("key --delay 50 t t t t t t");
    CHECK(rig.await([](const json& s) { return s["console"]["tree_level"] == 3; })); // last level
    CHECK(later(rig, 6 * 2 + 4)["console"]["tree_level"] == 3); // each press takes two frames: down and up
    closeQuietly(rig);
}

TEST_CASE("Key presses with and without Ctrl within one frame all count") {
    WindowRig rig;
    const json before = rig.state();
    const double scale = before["console"]["text_scale"];
    const bool guidance = before["console"]["guidance"];
    rig.xdo("key --delay 0 g ctrl+equal Tab"); // each key once, because a repeated one would count as held
    CHECK(rig.await([&](const json& s) {
        return s["console"]["text_scale"] == scale + 0.125 && s["console"]["large"] == "space" &&
               s["console"]["guidance"] != guidance;
    }));
    closeQuietly(rig);
}

TEST_CASE("F6 gives arrows and Enter to the panels and back, and the space bar presses nothing there") {
    WindowRig rig;
    const json before = rig.atRest();
    REQUIRE(!before.is_null());
    rig.key("F6");
    REQUIRE(rig.await([](const json& s) { return s["console"]["panels"] == true; }));
    // A few steps from any first item reach the row of buttons; Freeze is its last button.
    for (int i = 0; i < 4; ++i) {
        rig.key("Down");
    }
    for (int i = 0; i < 6; ++i) {
        rig.key("Up");
    }
    rig.key("Down");
    for (int i = 0; i < 6; ++i) {
        rig.key("Right");
    }
    rig.key("space");
    CHECK(later(rig)["console"]["frozen"] == false);
    rig.shoot("panels");
    rig.key("Return");
    REQUIRE(rig.await([](const json& s) { return s["console"]["frozen"] == true; }));
    const json there = rig.state();
    for (int i = 0; i < 3; ++i) {
        CHECK(there["run"]["device"][i].get<double>() ==
              doctest::Approx(before["run"]["device"][i].get<double>()));
    }
    rig.key("F6");
    REQUIRE(rig.await([](const json& s) { return s["console"]["panels"] == false; }));
    rig.keyDown("Up"); // arrows move the tool again
    CHECK(rig.await([&](const json& s) {
        return s["run"]["device"][1].get<double>() < before["run"]["device"][1].get<double>() - 0.005;
    }));
    rig.keyUp("Up");
    closeQuietly(rig);
}

TEST_CASE("The arrow keys move a cursor and Enter picks the colour under it") {
    WindowRig rig;
    const json before = rig.atRest();
    REQUIRE(!before.is_null());
    rig.key("k");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picking"] == true; }));
    rig.keyDown("Left"); // from the middle, which is red, to the yellow square
    const auto camera = rig.place("camera");
    REQUIRE(rig.await([&](const json& s) {
        const json& c = s["console"]["cursor"];
        return c.is_array() && c[0].get<double>() < camera[0] + camera[2] * 11.0 / 64.0;
    }));
    rig.keyUp("Left");
    rig.shoot("cursor");
    rig.key("Return");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picked"] == true; }));
    CHECK(rig.state()["selected"] == 10 * 14);
    CHECK(rig.state()["fixtures"].size() == 2); // the Enter that picked the colour has not added it
    rig.key("Return");
    REQUIRE(rig.await([](const json& s) { return s["fixtures"].size() == 3; }));
    const json after = rig.state();
    for (int i = 0; i < 3; ++i) { // the arrows did not move the tool
        CHECK(after["run"]["device"][i].get<double>() ==
              doctest::Approx(before["run"]["device"][i].get<double>()));
    }
    closeQuietly(rig);
}
