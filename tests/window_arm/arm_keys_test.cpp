// SPDX-License-Identifier: Apache-2.0
// A simulated arm in the window: a key for the jaws, and the arm's limits as text.
#include "tests/window/window_rig.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

const std::filesystem::path kWetmate = "apps/scenes/arm_wetmate.yaml";

bool holds(const json& s, const std::string& words) {
    const json& all = s["run"]["arm_holds"];
    return std::any_of(all.begin(), all.end(), [&](const json& one) {
        return one.get<std::string>().find(words) != std::string::npos;
    });
}

void arms(WindowRig& rig) {
    rig.reopen(kWetmate);
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
}

} // namespace

TEST_CASE("J closes and opens the jaws of an arm, and the window names the joint that limits the hand") {
    WindowRig rig;
    arms(rig);
    CHECK(rig.state()["run"]["grasp"] == 0.0);
    rig.key("j");
    CHECK(rig.await([](const json& s) { return s["run"]["grasp"] > 0.99; }));
    rig.key("j");
    CHECK(rig.await([](const json& s) { return s["run"]["grasp"] < 0.01; }));

    CHECK(rig.state()["run"]["arm_holds"].empty());
    rig.keyDown("Page_Down"); // towards and past the camera, so that the arm folds up
    CHECK(rig.await([](const json& s) { return holds(s, " limit"); }));
    rig.keyUp("Page_Down");
    const json still = rig.atRest();
    REQUIRE(!still.is_null());
    CHECK(holds(still, " limit"));
    rig.key("w");
    const Screenshot shot = rig.shoot("arm-held");
    CHECK(shot.share(rig.place("head arm held"),
                     [](int r, int g, int b) { return r > 180 && g > 130 && b < 120; }) > 0.02);
    rig.keyDown("Page_Up");
    CHECK(rig.await([](const json& s) { return !holds(s, " limit"); }));
    rig.keyUp("Page_Up");
    const int code = rig.close();
    CHECK_MESSAGE(code == 0, rig.output());
}
