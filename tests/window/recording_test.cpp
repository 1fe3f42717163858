// SPDX-License-Identifier: Apache-2.0
// What a pilot sees of a recording that runs and of one that is saved.
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

json recorded(const json& s) {
    return s["console"]["recorded"];
}

} // namespace

TEST_CASE(
    "The chip REC shows time, size and what is left on the disk; the saved recording names its folder") {
    WindowRig rig;
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return recorded(s)["seconds"] > 1.0; }));
    const json s = rig.state();
    CHECK(recorded(s)["bytes"] > 10'000);
    CHECK(recorded(s)["left"] > 1'000'000);
    const auto chip = s["chips"][0].get<std::string>();
    CHECK(chip.find("REC 0:0") == 0);
    CHECK(chip.find("B left") == chip.size() - 6);
    rig.shoot("rec");
    rig.key("r");
    REQUIRE(rig.awaitNotice("saved: "));
    CHECK(rig.state()["console"]["notice"].get<std::string>().find((rig.folder() / "recording-1").string()) !=
          std::string::npos);
    CHECK(rig.state()["chips"].empty());
    closeQuietly(rig);
}
