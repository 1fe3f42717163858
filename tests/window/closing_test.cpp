// SPDX-License-Identifier: Apache-2.0
// The close button: forces off first, then a question about fixtures that are not saved. Minimising.
#include "tests/window/felt.h"
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool asks(const json& s) {
    return s["console"]["asks_to_close"] == true && s["console"]["places"].contains("close save");
}

void addYellow(WindowRig& rig) {
    rig.key("k");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picking"] == true; }));
    rig.click("camera", 9.0 / 64.0, 23.0 / 48.0);
    REQUIRE(rig.await([](const json& s) { return s["console"]["picked"] == true; }));
    rig.key("Return");
    REQUIRE(rig.await([](const json& s) { return s["fixtures"].size() == 3; }));
}

} // namespace

TEST_CASE("Closing an armed window turns forces off, then asks about fixtures that are not saved, and Enter "
          "saves them") {
    WindowRig rig;
    addYellow(rig);
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == true; }));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["run"]["force_N"] > 0.2; }));
    rig.askToClose();
    REQUIRE(rig.await(asks));
    const json asked = rig.state();
    CHECK(asked["console"]["forces"] == false);
    CHECK(asked["run"]["force_N"] == 0.0);
    CHECK(asked["mode"] == "FORCES OFF");
    rig.shoot("closing");
    rig.key("a"); // nothing arms while the question is open
    CHECK(rig.state()["console"]["forces"] == false);
    rig.key("Escape");
    REQUIRE(rig.await([](const json& s) { return !asks(s); }));
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 100; }));
    rig.askToClose();
    REQUIRE(rig.await(asks));
    rig.key("Return");
    CHECK(rig.awaitEnd() == 0);
    CHECK(rig.sceneText().find("picked 1") != std::string::npos);
    CHECK(feltIn(rig.folder() / "recording-1" / "wrench.csv", 1, 7).size() >
          100); // the recording is complete
    CHECK(rig.output().find("validation") == std::string::npos);
}

TEST_CASE("Closing without changes asks nothing, and D closes without saving") {
    WindowRig rig;
    addYellow(rig);
    rig.askToClose();
    REQUIRE(rig.await(asks));
    rig.click("close discard");
    CHECK(rig.awaitEnd() == 0);
    CHECK(rig.sceneText().find("picked 1") == std::string::npos);
    WindowRig clean;
    clean.askToClose();
    CHECK(clean.awaitEnd() == 0);
    CHECK(clean.output().find("validation") == std::string::npos);
}

TEST_CASE("Minimising an armed window turns forces off") {
    WindowRig rig;
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.minimise(true);
    CHECK(rig.await([](const json& s) {
        return s["console"]["forces"] == false &&
               s["console"]["notice"].get<std::string>().find("minimised") != std::string::npos;
    }));
    rig.minimise(false);
    closeQuietly(rig);
}
