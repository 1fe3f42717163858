// SPDX-License-Identifier: Apache-2.0
// A recording with edited fixtures: replayed and shown on the time line.
#include "tests/rig/run_fathom.h"
#include "tests/window/felt.h"
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

void waitTicks(const WindowRig& rig, int ticks) {
    const auto now = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > now + ticks; }));
}

// Pushes against the bump, removes the red class, adds a sphere, undoes both, freezes everything for a
// while, and pushes again.
void fly(const WindowRig& rig) {
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == true; }));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["run"]["force_N"] > 1.0; }));
    waitTicks(rig, 500);
    rig.click("remove red");
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] == 0 && s["run"]["contacts"] == 0; }));
    rig.click("place sphere");
    rig.click("camera", 0.8, 0.2);
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 1; }));
    waitTicks(rig, 1000);
    rig.key("ctrl+z");
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 0; }));
    rig.key("ctrl+z");
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 200; }));
    rig.key("f");
    waitTicks(rig, 500);
    rig.key("f");
    waitTicks(rig, 500);
    rig.wheel(1); // until here the tool is where the class was removed, maybe just outside of the bump
    REQUIRE(rig.await([](const json& s) { return s["run"]["force_N"] > 1.0; }));
    rig.key("r");
    REQUIRE(rig.awaitNotice("frames recorded"));
}

} // namespace

TEST_CASE("Edits during a recording take effect in its replay and on its time line from the same frame on") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    fly(rig);
    const auto folder = rig.folder() / "recording-1", out = rig.folder() / "out";
    const std::vector<double> images = columnIn(folder / "edits.csv", 0),
                              still = columnIn(folder / "edits.csv", 3);
    REQUIRE(images.size() == 7); // start, removed, placed, undone twice, frozen, released
    CHECK(images[0] == 0);
    CHECK(still == std::vector<double>{0, 0, 0, 0, 0, 1, 0});
    const ProgramRun run =
        runFathom({"replay", folder.string(), "--device", "llvmpipe", "--out", out.string()});
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    const std::vector<double> spheres = columnIn(out / "frames.csv", 4);
    REQUIRE(static_cast<int>(spheres.size()) > images[6]);
    for (int i = 0; i < static_cast<int>(spheres.size()); ++i) {
        CAPTURE(i);
        const bool gone = i >= images[1] && i < images[4];
        const bool held = i >= images[5] && i < images[6]; // frozen frames make no set
        CHECK((held || (spheres[static_cast<size_t>(i)] == 0) == gone));
    }
    const auto felt = feltIn(folder / "wrench.csv", 1, 7), again = feltIn(out / "haptics.csv", 15, 21);
    REQUIRE(firstContact(felt) > 0.0);
    CHECK(std::abs(firstContact(felt) - firstContact(again)) < 0.25);
    constexpr double kAfter = 0.2; // [s] until every tick uses the newer set
    const double from = images[1] / 30.0 + kAfter, to = images[3] / 30.0 - kAfter;
    REQUIRE(to > from);
    for (const auto* rows : {&felt, &again}) {
        size_t within = 0;
        for (const Felt& f : *rows) {
            within += f.t > from && f.t < to ? 1 : 0;
            CHECK_FALSE((f.t > from && f.t < to && f.contact));
        }
        CHECK(within > 300);
        CHECK(rows->back().contact);
    }
    rig.reopen(folder);
    const double middle = 0.5 * (images[2] + images[3]) / 30.0,
                 all = rig.state()["console"]["time_line"]["duration"];
    rig.click("time line", middle / all);
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] == 0 && s["shapes"] == 1; }));
    CHECK(rig.state()["fixtures"][0]["name"] == "yellow");
    rig.click("time line", 0.1 * from / all);
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 200 && s["shapes"] == 0; }));
    CHECK(rig.state()["fixtures"][0]["name"] == "red");
    const int code = rig.close();
    CHECK_MESSAGE(code == 0, rig.output());
}

TEST_CASE("A shape of a scene file is removed while its classes of points stay active") {
    WindowRig rig;
    const auto scene = rig.folder() / "shaped.yaml";
    std::string text = rig.sceneText();
    const size_t at = text.find("fixtures:");
    REQUIRE(at != std::string::npos);
    text.insert(text.find('\n', at) + 1,
                "  - {name: ball, role: forbidden, shape: sphere, base_T_shape: {xyz: "
                "[0.2, 0, 0.5]}, size: [0.02, 0, 0]}\n");
    std::ofstream(scene) << text;
    rig.reopen(scene);
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 200 && s["shapes"] == 1; }));
    const json before = rig.state();
    rig.click("remove ball");
    REQUIRE(rig.await([&](const json& s) {
        return s["shapes"] == 0 && s["run"]["pictures"] > before["run"]["pictures"].get<int>() + 10;
    }));
    CHECK(rig.state()["run"]["spheres"] == before["run"]["spheres"]);
    rig.key("ctrl+z");
    CHECK(rig.await([](const json& s) { return s["shapes"] == 1; }));
    const int code = rig.close();
    CHECK_MESSAGE(code == 0, rig.output());
}
