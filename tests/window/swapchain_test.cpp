// SPDX-License-Identifier: Apache-2.0
// Lost swapchains, and the cost of the window for the haptic tick.
#include "tests/rig/run_fathom.h"
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

// The number after `name` in a line of the program's report; -1 = none.
double figureIn(const std::string& text, const std::string& name) {
    const size_t at = text.find(name);
    double value = -1.0;
    return at != std::string::npos && std::sscanf(text.c_str() + at + name.size(), "%lf", &value) == 1 ? value
                                                                                                       : -1.0;
}

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

TEST_CASE("The window is measured against the same run without it") {
    WindowRig rig;
    const auto out = rig.folder() / "plain";
    rig.reopen(rig.folder() / "scene.yaml", {"--path"});
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 5000; }, 60.0));
    REQUIRE(rig.close() == 0);
    const double with = figureIn(rig.output(), "step         p50 ");
    const ProgramRun plain = runFathom({"replay", (rig.folder() / "scene.yaml").string(), "--realtime",
                                        "--device", "llvmpipe", "--out", out.string()});
    REQUIRE_MESSAGE(plain.exitCode == 0, plain.err);
    std::ifstream file(out / "summary.json");
    const json summary = json::parse(file);
    const double without = summary.at("haptic").at("turn_us").at("p50").get<double>();
    REQUIRE(with > 0.0);
    REQUIRE(without > 0.0);
    MESSAGE("step p50 with the window "
            << with << " us, without " << without << " us: ratio " << with / without
            << "; late with it: " << rig.output().substr(rig.output().find("step  ")));
}
