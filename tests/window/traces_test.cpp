// SPDX-License-Identifier: Apache-2.0
// Bars and traces of force and torque in the window.
#include "tests/window/window_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool isForce(int r, int g, int b) {
    return std::abs(r - 255) < 10 && std::abs(g - 194) < 10 && std::abs(b - 51) < 10;
}

// A rectangle of height `high` around a row at this share of a place's height, over a share of its width.
std::array<double, 4> band(const std::array<double, 4>& of, double row, double high, double from, double to) {
    return {of[0] + from * of[2], of[1] + row * of[3] - 0.5 * high, (to - from) * of[2], high};
}

} // namespace

TEST_CASE("Bar and trace show the same force on a scale that ends at the limit, and torque without motors "
          "is residual") {
    WindowRig rig;
    std::string scene = rig.sceneText();
    for (const auto& [was, is] :
         {std::pair<std::string, std::string>("friction: 0", "device: falcon, stiffness: 300, friction: 0"),
          {"[[0, 0, 0, 0.01]", "[[0, 0.02, 0, 0.01]"}}) { // touches beside its centre
        REQUIRE(scene.find(was) != std::string::npos);
        scene.replace(scene.find(was), was.size(), is);
    }
    std::ofstream(rig.folder() / "falcon.yaml") << scene;
    rig.reopen(rig.folder() / "falcon.yaml");
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["figures"][0]["delivered"] > 0.5; }));
    for (int i = 0; i < 20 && rig.state()["figures"][0]["delivered"] > 5.0; ++i) {
        rig.wheel(-1);
    }
    REQUIRE(!rig.atRest().is_null());
    const auto begun = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > begun + 1500; }));
    const json force = rig.state()["figures"][0], torque = rig.state()["figures"][1];
    const double share = force["delivered"].get<double>() / force["limit"].get<double>();
    CHECK(force["peak"] >= force["delivered"]);
    CHECK(force["ripple"].is_number());
    CHECK(torque["delivered"] == 0.0);
    CHECK(torque["residual"] > 0.0);
    const Screenshot shot = rig.shoot("traces");
    const auto plot = rig.place("trace Force"), bar = rig.place("bar Force");
    const double row = 0.5 - 0.5 * 0.9 * share;
    CHECK(shot.share(band(plot, row, 7.0, 0.9, 0.99), isForce) > 0.2);
    CHECK(shot.share(band(plot, 0.5 - 0.5 * 0.9 * (share + 0.3), 7.0, 0.9, 0.99), isForce) < 0.01);
    CHECK(shot.share(band(bar, 0.5, 4.0, 0.02, 0.9 * share - 0.02), isForce) > 0.8);
    CHECK(shot.share(band(bar, 0.5, 4.0, 0.9 * share + 0.03, 0.86), isForce) < 0.01);
    closeQuietly(rig);
}
