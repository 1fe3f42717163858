// SPDX-License-Identifier: Apache-2.0
// The pilot's layout and the stop plate in the window.
#include "tests/window/window_rig.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

TEST_CASE("F2 changes to the pilot's layout and back, keys open and close its panel, and saving keeps it") {
    WindowRig rig;
    const double before = rig.place("camera")[2];
    rig.key("F2");
    REQUIRE(rig.await([&](const json& s) {
        return s["console"]["layout"] == "pilot" && s["console"]["places"].contains("force strip") &&
               s["console"]["places"]["camera"][2] > before + 50.0;
    }));
    rig.shoot("pilot-layout");
    CHECK(rig.state()["console"]["panel_open"] == false);
    rig.key("F1");
    REQUIRE(rig.await(
        [](const json& s) { return s["console"]["panel_open"] == true && s["console"]["tab"] == 3; }));
    rig.shoot("pilot-keys");
    rig.key("Escape");
    REQUIRE(rig.await([](const json& s) { return s["console"]["panel_open"] == false; }));
    rig.key("ctrl+s");
    REQUIRE(rig.awaitNotice("fixtures saved"));
    CHECK(rig.sceneText().find("layout: pilot") != std::string::npos);
    rig.reopen(rig.folder() / "scene.yaml");
    CHECK(rig.state()["console"]["layout"] == "pilot");
    rig.key("F2");
    CHECK(rig.await([](const json& s) { return s["console"]["layout"] == "engineer"; }));
    closeQuietly(rig);
}

TEST_CASE("The stop plate is on screen in both layouts, and a click on it turns forces off") {
    WindowRig rig;
    for (int layout = 0; layout < 2; ++layout) {
        rig.key("a");
        REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
        const auto hand = rig.state()["run"]["device"];
        rig.click("stop");
        CHECK(rig.await([](const json& s) {
            return s["console"]["forces"] == false && s["mode"] == "FORCES OFF" && s["run"]["force_N"] == 0.0;
        }));
        CHECK(rig.state()["run"]["device"] == hand);
        rig.key("F2");
        REQUIRE(rig.await(
            [&](const json& s) { return s["console"]["layout"] == (layout == 0 ? "pilot" : "engineer"); }));
    }
    closeQuietly(rig);
}

TEST_CASE("State word, figures and buttons explain themselves under the mouse") {
    WindowRig rig;
    for (const auto& [place, text] : {std::pair("mode", "The device gets no force"),
                                      std::pair("figure scene age", "Time since the camera took the image"),
                                      std::pair("Undo", "Ctrl Z: take back")}) {
        const std::string words = text;
        const auto at = rig.place(place);
        rig.xdo("mousemove --window $W " + std::to_string(std::lround(at[0] + 0.5 * at[2])) + " " +
                std::to_string(std::lround(at[1] + 0.5 * at[3])));
        CHECK(rig.await(
            [&](const json& s) { return s["console"]["tooltip"].get<std::string>().find(words) == 0; }));
        rig.shoot(std::string("tooltip-") + place);
    }
    closeQuietly(rig);
}

TEST_CASE("On a monitor of twice the usual resolution, window and text are larger without a setting") {
    WindowRig rig({}, {.perInch = 192});
    const json s = rig.state();
    CHECK(s["console"]["monitor_scale"] == 2.0);
    CHECK(s["console"]["text_scale"] == 1.0);
    CHECK(s["window"]["width"] == 1920); // all of the monitor: twice 1280 is wider
    CHECK(s["window"]["height"] == 1080);
    CHECK(s["console"]["drawn_scale"] > 1.8);
    rig.shoot("monitor-dense");
    rig.key("ctrl+minus");
    rig.key("ctrl+minus");
    CHECK(rig.await([](const json& now) { return now["console"]["drawn_scale"] == 1.5; }));
    closeQuietly(rig);
}

TEST_CASE("Text that the window has no room for is drawn smaller, and as large as asked when it has") {
    WindowRig rig({"--text-scale", "2.5"});
    CHECK(rig.state()["console"]["text_scale"] == 2.5);
    CHECK(rig.state()["console"]["drawn_scale"] == 1.25);
    rig.xdo("windowsize --sync $W 1900 1060");
    REQUIRE(rig.await([](const json& s) { return s["console"]["drawn_scale"] > 1.8; }));
    rig.shoot("text-large");
    closeQuietly(rig);
}
