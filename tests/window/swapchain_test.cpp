// SPDX-License-Identifier: Apache-2.0
// Lost swapchains and a minimised window. Hand and frames continue.
#include "tests/window/window_rig.h"

#include <cstdlib>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool isGrey(int r, int g, int b) { // grey as the wall
    return std::abs(r - g) < 3 && std::abs(g - b) < 3 && r > 100;
}

} // namespace

TEST_CASE("A lost swapchain is recreated, again and again, while hand and frames continue") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    for (int i = 0; i < 5; ++i) {
        const json before = rig.state();
        rig.key("ctrl+F11");
        REQUIRE(rig.await([&](const json& s) {
            return s["window"]["swapchains"] > before["window"]["swapchains"].get<int>() &&
                   s["window"]["frames"] > before["window"]["frames"].get<int>() + 3 &&
                   s["run"]["turns"] > before["run"]["turns"].get<int>() + 50;
        }));
    }
    CHECK(rig.shoot("after-loss").share(rig.place("camera"), isGrey) > 0.3);
    CHECK(rig.close() == 0);
    CHECK(rig.output().find("validation") == std::string::npos);
    CHECK(rig.output().find("step         p50 ") != std::string::npos); // the report at the end
}

TEST_CASE("A minimised window draws nothing while the hand continues, and is restored afterwards") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    rig.minimise(true);
    json still;
    REQUIRE(rig.await([&](const json& s) { // no frame drawn during 500 ticks
        if (still.is_null() || s["window"]["frames"] != still["window"]["frames"]) {
            still = s;
        }
        return s["run"]["turns"] > still["run"]["turns"].get<int>() + 500;
    }));
    rig.minimise(false);
    REQUIRE(rig.await(
        [&](const json& s) { return s["window"]["frames"] > still["window"]["frames"].get<int>() + 5; }));
    CHECK(rig.shoot("after-minimise").share(rig.place("camera"), isGrey) > 0.3);
    CHECK(rig.close() == 0);
    CHECK(rig.output().find("validation") == std::string::npos);
}
