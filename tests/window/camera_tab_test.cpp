// SPDX-License-Identifier: Apache-2.0
// The tab of the camera in the window.
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

constexpr int kCameraTab = 4;

} // namespace

TEST_CASE(
    "F3 shows the streams of a recording, how old its frames are in the force, and that it has no controls") {
    WindowRig rig;
    rig.key("F3");
    REQUIRE(rig.await([](const json& s) {
        return s["console"]["tab"] == kCameraTab && s["console"]["places"].contains("no controls");
    }));
    const json camera = rig.state()["camera"];
    REQUIRE(camera["streams"].size() == 2);
    CHECK(camera["streams"][0]["name"] == "depth");
    CHECK(camera["streams"][0]["width"] == kWidth);
    CHECK(camera["no_controls"] == "A recording or simulation has no exposure, gain or laser to set.");
    REQUIRE(rig.await([](const json& s) { return s["camera"]["delay_s"].is_number(); }));
    CHECK(rig.state()["camera"]["worst_delay_s"] >= rig.state()["camera"]["delay_s"]);
    rig.shoot("camera-tab");
    rig.xdo("windowsize --sync $W 800 480");
    rig.key("F2");
    rig.key("F3");
    REQUIRE(rig.await([](const json& s) { return s["console"]["panel_open"] == true; }));
    rig.shoot("camera-tab-small");
    rig.key("F3");
    CHECK(rig.await([](const json& s) { return s["console"]["panel_open"] == false; }));
    closeQuietly(rig);
}
