// SPDX-License-Identifier: Apache-2.0
// On a device that is the CPU itself, a window that shows nothing new costs next to nothing.
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

TEST_CASE("A recording that stands still is not drawn again until a key moves it") {
    WindowRig rig;
    rig.reopen(rig.folder() / "scene.yaml", {"--recording", (rig.folder() / "recording").string()});
    json still;
    REQUIRE(rig.await([&](const json& s) { // 20 frames of the window without a tile
        if (still.is_null() || s["window"]["tiles"] != still["window"]["tiles"]) {
            still = s;
        }
        return s["window"]["frames"] > still["window"]["frames"].get<int>() + 20;
    }));
    CHECK(still["window"]["tiles"] > 0);
    rig.key("F2");
    REQUIRE(rig.await([&](const json& s) { return s["window"]["tiles"] > still["window"]["tiles"]; }));
    closeQuietly(rig);
}
