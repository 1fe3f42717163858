// SPDX-License-Identifier: Apache-2.0
// What a pick would make before Enter, and new names of fixtures.
#include "tests/window/window_rig.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool isPicked(int r, int g, int b) {
    return std::abs(r - 40) < 24 && std::abs(g - 220) < 24 && std::abs(b - 235) < 24;
}

} // namespace

TEST_CASE("A picked colour shows its final regions before Enter, and warns that they cover the target") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 0; }));
    rig.key("k");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picking"] == true; }));
    rig.click("camera", 9.0 / 64.0, 23.0 / 48.0); // the yellow square, which is also the target
    REQUIRE(rig.await([](const json& s) { return s["console"]["picked"] == true; }));
    REQUIRE(rig.await([](const json& s) { return s["console"]["pick_warnings"].size() == 1; }));
    CHECK(rig.state()["console"]["pick_warnings"][0] == "covers the target 'yellow'");
    const auto camera = rig.place("camera");
    const std::array<double, 4> around{camera[0], camera[1] + 0.2 * camera[3], 0.32 * camera[2],
                                       0.13 * camera[3]}; // above the square, where its spheres reach
    CHECK(rig.shoot("ghost").share(around, isPicked) > 0.008);
    rig.click("role guidance"); // a target has no regions
    REQUIRE(rig.await([](const json& s) { return s["console"]["pick_warnings"].empty(); }));
    CHECK(rig.shoot("ghost-none").share(around, isPicked) < 0.001);
    rig.key("Escape");
    closeQuietly(rig);
}

TEST_CASE("A fixture is renamed in the panel, and undo gives the old name back") {
    WindowRig rig;
    rig.click("rename red");
    REQUIRE(rig.await([](const json& s) { return s["console"]["places"].contains("new name"); }));
    rig.xdo("type --delay 60 valve");
    rig.shoot("rename");
    rig.key("Return");
    REQUIRE(rig.await([](const json& s) { return s["fixtures"][0]["name"] == "valve"; }));
    CHECK(rig.state()["console"]["forces"] == false); // letters are text
    rig.key("ctrl+z");
    CHECK(rig.await([](const json& s) { return s["fixtures"][0]["name"] == "red"; }));
    closeQuietly(rig);
}
