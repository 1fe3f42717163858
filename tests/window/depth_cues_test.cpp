// SPDX-License-Identifier: Apache-2.0
// Depth and distance in the window: tether, gap bar, hidden tool, sides of the 3D view.
#include "tests/window/window_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool isAmber(int r, int g, int b) {
    return std::abs(r - 255) < 12 && std::abs(g - 190) < 12 && std::abs(b - 60) < 16;
}

bool isWarning(int r, int g, int b) {
    return std::abs(r - 255) < 12 && std::abs(g - 92) < 12 && std::abs(b - 84) < 12;
}

double gapOf(const json& s) {
    const json& gap = s["depth_cues"]["gap_m"];
    return gap.is_number() ? gap.get<double>() : -1.0;
}

// Wheel notches away from the pilot until the look is reached.
void approach(WindowRig& rig, const std::string& look) {
    rig.xdo("mousemove --window $W 300 300");
    for (int i = 0; i < 60 && rig.state()["depth_cues"]["look"] != look; ++i) {
        rig.wheel(1);
    }
    REQUIRE(rig.await([&](const json& s) { return s["depth_cues"]["look"] == look; }));
}

} // namespace

TEST_CASE(
    "Tether and gap bar follow the tool to the region: white, amber, red, with the head line's distance") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["depth_cues"]["look"] == "far"; }));
    const json far = rig.state();
    CHECK(far["depth_cues"]["tether"].is_array());
    CHECK(far["depth_cues"]["shadow"] > 0);
    const Screenshot white = rig.shoot("gap-far");
    const auto bar = rig.place("gap bar");
    CHECK(white.share(bar, [](int r, int g, int b) { return r > 250 && g > 250 && b > 250; }) > 0.02);
    approach(rig, "near");
    REQUIRE(!rig.atRest().is_null());
    CHECK(gapOf(rig.state()) < 0.05);
    const Screenshot amber = rig.shoot("gap-near");
    CHECK(amber.share(bar, isAmber) > white.share(bar, isAmber) + 0.005);
    approach(rig, "close");
    REQUIRE(!rig.atRest().is_null());
    const json close = rig.state();
    CHECK(gapOf(close) < 0.01);
    const Screenshot red = rig.shoot("gap-close");
    CHECK(red.share(bar, isWarning) > amber.share(bar, isWarning) + 0.003);
    const glm::dvec3 from = vec(close["depth_cues"]["tether"][0]), to = vec(close["depth_cues"]["tether"][1]);
    CHECK(std::abs(glm::length(to - from) - gapOf(close)) < 0.004);
    closeQuietly(rig);
}

TEST_CASE("The tool is dotted where a surface hides it") {
    WindowRig rig;
    CHECK(rig.state()["depth_cues"]["hidden"] == 0.0);
    rig.keyDown("Down"); // away from the bump; the wall is no region
    CHECK(rig.await([](const json& s) { return s["run"]["device"][1] > 0.12; }));
    rig.keyUp("Down");
    rig.xdo("mousemove --window $W 300 300");
    for (int i = 0; i < 80 && rig.state()["run"]["tool"][2] < 0.68; ++i) {
        rig.wheel(2);
    }
    CHECK(rig.await([](const json& s) { return s["depth_cues"]["hidden"] > 0.9; }));
    rig.shoot("hidden");
    closeQuietly(rig);
}

TEST_CASE("1, 2, 3 and 0 show the scene in 3D from the front, the side and the top, and reset the view") {
    WindowRig rig;
    rig.key("Tab");
    const auto looks = [&](const char* key, double yaw, double pitch) {
        rig.key(key);
        const bool there = rig.await([&](const json& s) {
            const json& orbit = s["console"]["orbit"];
            return std::abs(orbit["yaw"].get<double>() - yaw) < 1e-3 &&
                   std::abs(orbit["pitch"].get<double>() - pitch) < 1e-3;
        });
        rig.shoot(std::string("side-") + key);
        return there;
    };
    CHECK(looks("1", 0.0, 0.0));
    CHECK(looks("2", 1.5708, 0.0));
    CHECK(looks("3", 0.0, 1.5708));
    CHECK(looks("0", 0.55, 0.45));
    closeQuietly(rig);
}

TEST_CASE("Side and top views show the tool before the region, in both layouts and in a small window") {
    WindowRig rig;
    approach(rig, "close");
    REQUIRE(!rig.atRest().is_null());
    const auto red = [](int r, int g, int b) { return r > 120 && g < 50 && b < 50; };
    const auto white = [](int r, int g, int b) { return r > 240 && g > 240 && b > 240; };
    const auto shows = [&](const std::string& keep) {
        const Screenshot shot = rig.shoot(keep);
        for (const char* name : {"close-up side", "close-up top"}) {
            CAPTURE(name);
            CHECK(shot.share(rig.place(name), red) > 0.04);
            CHECK(shot.share(rig.place(name), white) > 0.0015);
        }
        // In the side view the camera is at the left: the tool is left of the region.
        const auto side = rig.place("close-up side");
        const std::array<double, 4> left{side[0], side[1], 0.4 * side[2], side[3]};
        CHECK(shot.share(left, red) < 0.01);
    };
    CHECK(rig.state()["depth_cues"]["side"] > 0);
    shows("close-ups");
    rig.key("F2");
    REQUIRE(rig.await([](const json& s) { return s["console"]["layout"] == "pilot"; }));
    shows("close-ups-pilot");
    rig.xdo("windowsize --sync $W 800 480");
    REQUIRE(rig.await([](const json& s) { return s["window"]["width"] == 800; }));
    shows("close-ups-small");
    closeQuietly(rig);
}
