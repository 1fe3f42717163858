// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/run_fathom.h"
#include "tests/window/felt.h"
#include "tests/window/window_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <thread>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool isBlue(int r, int g, int b) {
    return b > 180 && r < 130 && g > 90 && g < 200;
}
bool isCyan(int r, int g, int b) {
    return g > 150 && b > 150 && r < 120;
}

double toolZ(const json& s) {
    return s["run"]["tool"][2];
}

// [m] of the hand beyond the tool.
double depthOf(const json& s) {
    return glm::distance(vec(s["run"]["device"]), vec(s["run"]["tool"]));
}

bool silent(WindowRig& rig) {
    const int code = rig.close();
    INFO(rig.output());
    CHECK(code == 0);
    CHECK(rig.output().find("validation") == std::string::npos);
    return code == 0;
}

// Moves the tool to the axis of the bump and pushes it against the bump.
void pushIntoBump(WindowRig& rig) {
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    rig.push();
}

} // namespace

TEST_CASE("The window shows the camera image, the forbidden region in red and unobserved areas hatched") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 0 && s["run"]["turns"] > 200; }));
    const Screenshot shot = rig.shoot("camera");
    CHECK(shot.width == 1280);
    CHECK((shot.height > 720 && shot.height < 790)); // with a caption below
    const auto camera = rig.place("camera");
    const auto part = [&](double u, double v, double w, double h) {
        return std::array<double, 4>{camera[0] + u * camera[2], camera[1] + v * camera[3], w * camera[2],
                                     h * camera[3]};
    };
    CHECK(shot.share(part(0.40, 0.35, 0.25, 0.3), isRed) > 0.5);   // the bump
    CHECK(shot.share(part(0.02, 0.02, 0.12, 0.12), isRed) < 0.02); // the wall
    // The region covers grey wall next to the bump, hatched in red.
    const auto reddish = [](int r, int g, int b) { return r > g + 15 && r > b + 15; };
    CHECK(shot.share(part(0.33, 0.57, 0.035, 0.13), reddish) > 0.9); // below tool and tether
    CHECK(shot.share(part(0.27, 0.4, 0.02, 0.2), reddish) < 0.02);
    // The corner without depth: dark and bright stripes, neither the wall's grey.
    const auto bright = [](int r, int, int b) { return r > 150 && b > 170; };
    const auto dark = [](int r, int g, int b) { return r < 90 && g < 90 && b < 100; };
    CHECK(shot.share(part(0.85, 0.82, 0.1, 0.1), bright) > 0.15);
    CHECK(shot.share(part(0.85, 0.82, 0.1, 0.1), dark) > 0.3);
    const auto grey = [](int r, int g, int b) { return std::abs(r - g) < 3 && std::abs(g - b) < 3; };
    CHECK(shot.share(part(0.85, 0.82, 0.1, 0.1), grey) < 0.05);
    CHECK(shot.share(part(0.85, 0.05, 0.1, 0.1), grey) > 0.9);
    CHECK(rig.state()["unknown_share"] == doctest::Approx(14.0 * 12.0 / (64.0 * 48.0)).epsilon(0.01));
    silent(rig);
}

TEST_CASE("Forces are off at first, turned on with A and off with the space bar") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "FORCES OFF" && s["run"]["turns"] > 100; }));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.key("space");
    CHECK(rig.await([](const json& s) {
        return s["console"]["forces"] == false && s["mode"] == "FORCES OFF" && s["run"]["force_N"] == 0.0;
    }));
    silent(rig);
}

TEST_CASE("Keys and wheel drive the tool to the region's surface, where it stops and says why, and the space "
          "bar removes the force") {
    WindowRig rig;
    pushIntoBump(rig);
    REQUIRE(rig.await([](const json& s) { return s["run"]["contacts"] > 0 && s["run"]["force_N"] > 0.2; }));
    const json s = rig.state();
    const double hand = s["run"]["device"][2], tool = toolZ(s);
    CHECK(hand > tool + 0.001); // the hand moved on, the tool did not
    CHECK(s["run"]["touches"] > 0);
    rig.key("w");
    REQUIRE(rig.await([](const json& now) { return now["console"]["tab"] == 1; }));
    rig.shoot("why");
    CHECK(rig.state()["why"].get<std::string>().find("'red'") != std::string::npos);
    CHECK(rig.state()["why"].get<std::string>().find("since frame") != std::string::npos);
    rig.key("space");
    CHECK(rig.await(
        [](const json& now) { return now["run"]["force_N"] == 0.0 && now["console"]["forces"] == false; },
        5.0));
    silent(rig);
}

TEST_CASE("Forces armed in contact ramp up slowly, tick by tick") {
    constexpr double kFull = 0.9;
    WindowRig rig;
    pushIntoBump(rig);
    REQUIRE(rig.await([](const json& s) { return s["run"]["contacts"] > 0 && s["run"]["force_N"] > 1.0; }));
    REQUIRE(!rig.atRest().is_null());
    rig.key("space");
    REQUIRE(rig.await([](const json& s) { return s["run"]["force_N"] == 0.0; }));
    for (int i = 0; i < 30 && depthOf(rig.state()) > 0.009; ++i) { // deeper, they would stay off
        rig.wheel(-1);
        const auto now = rig.state()["run"]["turns"].get<int>();
        REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > now + 100; }));
    }
    REQUIRE(rig.state()["run"]["contacts"] > 0);
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == true; }));
    const auto begun = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > begun + 200; }));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    const auto armed = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > armed + 3000; }));
    rig.key("r");
    REQUIRE(rig.awaitNotice("frames recorded"));
    const auto felt = feltIn(rig.folder() / "recording-1" / "wrench.csv", 1, 7);
    const double most = std::max_element(felt.begin(), felt.end(), [](const Felt& a, const Felt& b) {
                            return a.force < b.force;
                        })->force;
    REQUIRE(most > 0.3);
    const auto row = [&](double share) {
        return std::find_if(felt.begin(), felt.end(), [&](const Felt& f) { return f.force > share * most; }) -
               felt.begin();
    };
    CHECK(felt.front().force == 0.0);
    // Counts ticks, which may be late. Late ticks soften the springs, so the largest force may come early.
    // The ramp rises by the limit of 20 N in 1.5 s.
    CHECK(static_cast<double>(row(kFull) - row(0.01)) > 0.6 * 1500.0 * (kFull - 0.01) * most / 20.0);
    silent(rig);
}

TEST_CASE("Guidance is turned on with G, is drawn blue, and pulls") {
    WindowRig rig;
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.key("g");
    REQUIRE(
        rig.await([](const json& s) { return s["run"]["guidance_w"] > 0.95 && s["run"]["force_N"] > 0.05; }));
    // On a busy machine frames may be late, so that forces fade and return.
    bool blue = false;
    for (int tries = 0; tries < 10 && !blue; ++tries) {
        CHECK(rig.await([](const json& s) { return s["mode"] == "ARMED" && s["chips"] == json{"GUIDE"}; }));
        const Screenshot shot = rig.shoot("guidance");
        blue =
            shot.share(rig.place("camera"), isBlue) > 0.0005 && shot.share(rig.place("mode"), isBlue) > 0.02;
    }
    CHECK(blue);
    silent(rig);
}

TEST_CASE("A colour is picked by a click, previewed, added, used, undone, redone and saved") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 0; }));
    const auto before = rig.state()["run"]["spheres"].get<size_t>();
    rig.key("k");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picking"] == true; }));
    rig.click("camera", 9.0 / 64.0, 23.0 / 48.0); // the yellow square
    REQUIRE(rig.await([](const json& s) { return s["console"]["picked"] == true; }));
    CHECK(rig.state()["selected"] == 10 * 14);
    CHECK(rig.state()["run"]["spheres"].get<size_t>() == before); // not active yet
    const Screenshot shot = rig.shoot("pick");
    const auto camera = rig.place("camera");
    CHECK(shot.share({camera[0] + camera[2] * 5 / 64, camera[1] + camera[3] * 17 / 48, camera[2] * 8 / 64,
                      camera[3] * 12 / 48},
                     isCyan) > 0.3);
    rig.key("Return");
    REQUIRE(
        rig.await([&](const json& s) { return s["fixtures"].size() == 3 && s["run"]["spheres"] > before; }));
    rig.key("ctrl+z");
    REQUIRE(
        rig.await([&](const json& s) { return s["fixtures"].size() == 2 && s["run"]["spheres"] == before; }));
    rig.key("ctrl+y");
    REQUIRE(
        rig.await([&](const json& s) { return s["fixtures"].size() == 3 && s["run"]["spheres"] > before; }));
    rig.key("ctrl+s");
    REQUIRE(rig.awaitNotice("3 fixtures saved"));
    CHECK(rig.sceneText().find("# a comment that saving must keep") != std::string::npos);
    CHECK(rig.sceneText().find("picked 1") != std::string::npos);
    silent(rig);
}

TEST_CASE("Frozen fixtures keep their set while frames arrive") {
    WindowRig rig;
    rig.key("f");
    REQUIRE(rig.await([](const json& s) { return s["console"]["frozen"] == true; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    const json first = rig.state();
    REQUIRE(rig.await(
        [&](const json& s) { return s["run"]["pictures"] > first["run"]["pictures"].get<int>() + 5; }));
    CHECK(rig.state()["run"]["generation"] == first["run"]["generation"]);
    rig.key("f");
    CHECK(rig.await(
        [&](const json& s) { return s["run"]["generation"] > first["run"]["generation"].get<int>(); }));
    silent(rig);
}

TEST_CASE("Tab swaps the views, P pauses the traces, E exports them, Q acknowledges") {
    WindowRig rig;
    rig.key("Tab");
    REQUIRE(rig.await([](const json& s) { return s["console"]["large"] == "space"; }));
    CHECK(rig.await([](const json& s) { // takes effect in the next frame
        return s["console"]["places"]["space"][2] > s["console"]["places"]["camera"][2];
    }));
    rig.key("t");
    const Screenshot shot = rig.shoot("space");
    CHECK(shot.share(rig.place("space"), isRed) > 0.005);
    rig.key("p");
    REQUIRE(rig.await([](const json& s) { return s["console"]["paused"] == true; }));
    rig.key("e");
    REQUIRE(rig.awaitNotice("traces written"));
    std::ifstream csv(rig.folder() / "traces.csv");
    std::string head;
    std::getline(csv, head);
    CHECK(head.starts_with("t_s,fx,fy,fz,tx,ty,tz,frame,state,residual_fx,"));
    size_t rows = 0;
    for (std::string line; std::getline(csv, line);) {
        ++rows;
    }
    CHECK(rows > 100);
    silent(rig);
}

TEST_CASE("The window can be made smaller, larger and unmapped while it runs") {
    WindowRig rig;
    rig.xdo("windowsize --sync $W 900 600");
    REQUIRE(rig.await(
        [](const json& s) { return s["window"]["width"] == 900 && s["window"]["swapchains"] >= 2; }));
    rig.xdo("windowsize --sync $W 1600 900");
    REQUIRE(rig.await(
        [](const json& s) { return s["window"]["width"] == 1600 && s["window"]["swapchains"] >= 3; }));
    const Screenshot shot = rig.shoot("large");
    CHECK(shot.width == 1600);
    rig.xdo("windowunmap --sync $W");
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 300; })); // the hand continues
    rig.xdo("windowmap --sync $W");
    const auto frames = rig.state()["window"]["frames"].get<int>();
    CHECK(rig.await([&](const json& s) { return s["window"]["frames"] > frames + 5; }));
    silent(rig);
}

TEST_CASE("Replay plays a recording made with R with the force that the hand felt") {
    WindowRig rig;
    rig.key("r");
    REQUIRE(rig.await([](const json& s) { return s["console"]["recording"] == true; }));
    pushIntoBump(rig);
    REQUIRE(rig.await([](const json& s) { return s["run"]["force_N"] > 1.0; }));
    const auto begun = rig.state()["run"]["turns"].get<int>();
    bool even = true;              // every tick was on time
    for (int i = 0; i < 15; ++i) { // 3 s, by which the soft start has ended
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        const json run = rig.state()["run"];
        even = even && run["haptic_hz"] > 980.0 && run["worst_period_ms"] < 2.0;
    }
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > begun + 1500; }));
    rig.key("r");
    REQUIRE(rig.awaitNotice("frames recorded"));
    const std::filesystem::path folder = rig.folder() / "recording-1";
    const auto out = rig.folder() / "out";
    const ProgramRun run =
        runFathom({"replay", folder.string(), "--device", "llvmpipe", "--out", out.string()});
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    const auto felt = feltIn(folder / "wrench.csv", 1, 7), again = feltIn(out / "haptics.csv", 15, 21);
    REQUIRE(std::min(felt.size(), again.size()) > 1000);
    REQUIRE(firstContact(felt) > 0.0);
    CHECK(std::abs(firstContact(felt) - firstContact(again)) < 0.25);
    const double last = felt.back().force, replayed = again[again.size() - 200].force;
    MESSAGE("felt " << last << " N, replayed " << replayed << " N, ticks on time: " << even);
    CHECK(last > 1.0);
    // Late ticks soften the springs for two seconds (StiffnessWatch); a replay has no late ticks.
    CHECK(replayed > 0.95 * last);
    if (even) {
        CHECK(std::abs(firstRise(felt) - firstRise(again)) < 0.4);
        CHECK(replayed == doctest::Approx(last).epsilon(0.05));
    }
    silent(rig);
}
