// SPDX-License-Identifier: Apache-2.0
// What the window puts on the screen: nothing while nothing changes, and all of it with F11.
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

TEST_CASE("A recording that stands still is not drawn again until a key changes the layout") {
    WindowRig rig;
    rig.reopen(rig.folder() / "scene.yaml", {"--recording", (rig.folder() / "recording").string()});
    constexpr int kFrames = 20, kMax = 12; // tiles per frame: the rate of the window in the top line
    const json before = rig.state()["window"];
    CHECK(before["tiles"] >= 240);
    REQUIRE(rig.await(
        [&](const json& s) { return s["window"]["frames"] > before["frames"].get<int>() + kFrames; }, 60.0));
    const json after = rig.state()["window"];
    CHECK(after["tiles"].get<int>() - before["tiles"].get<int>() <
          kMax * (after["frames"].get<int>() - before["frames"].get<int>()));
    rig.key("F2");
    REQUIRE(rig.await(
        [&](const json& s) { return s["window"]["tiles"].get<int>() > after["tiles"].get<int>() + 100; }));
    closeQuietly(rig);
}

TEST_CASE(
    "F11 fills the monitor and brings the window back, and Z looks at the 3D view from its start again") {
    WindowRig rig;
    const json before = rig.state()["window"];
    rig.key("F11");
    REQUIRE(rig.await([](const json& s) {
        return s["console"]["full_screen"] == true && s["window"]["width"] == 1920 &&
               s["window"]["height"] == 1080;
    }));
    rig.key("F11");
    REQUIRE(rig.await([&](const json& s) {
        return s["window"]["width"] == before["width"] && s["window"]["height"] == before["height"];
    }));
    const json orbit = rig.state()["console"]["orbit"];
    rig.key("3");
    REQUIRE(rig.await([&](const json& s) { return s["console"]["orbit"] != orbit; }));
    rig.key("z");
    REQUIRE(rig.await([&](const json& s) { return s["console"]["orbit"] == orbit; }));
    closeQuietly(rig);
}
