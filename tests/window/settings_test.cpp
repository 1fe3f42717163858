// SPDX-License-Identifier: Apache-2.0
// Pilot profiles, saved settings, frozen and boxed classes.
#include "tests/rig/run_fathom.h"
#include "tests/window/window_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::filesystem::path withPilots(const WindowRig& rig) {
    const auto file = rig.folder() / "pilots.yaml";
    std::ofstream(file) << rig.sceneText()
                        << "\npilots:\n"
                           "  - {name: anna, stiffness: 300, limits: {force: 2}}\n"
                           "  - {name: ben, stiffness: 150, limits: {force: 5}, scale: 0.5}\n";
    return file;
}

double apart(const json& a, const json& b) {
    double sum = 0.0;
    for (size_t i = 0; i < 3; ++i) {
        sum += std::pow(a["run"]["tool"][i].get<double>() - b["run"]["tool"][i].get<double>(), 2.0);
    }
    return std::sqrt(sum);
}

} // namespace

TEST_CASE(
    "A pilot chosen by name or in the window turns forces off, keeps the tool, and sets springs and limits") {
    WindowRig rig;
    const auto scene = withPilots(rig);
    rig.reopen(scene, {"--pilot", "ben"});
    CHECK(rig.state()["pilot"]["name"] == "ben");
    CHECK(rig.state()["pilot"]["stiffness"] == doctest::Approx(150.0));
    CHECK(rig.state()["pilot"]["force_limit"] == 5.0);
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.keyDown("Up");
    REQUIRE(rig.await([](const json& s) { return s["run"]["device"][1] < -0.05; }));
    rig.keyUp("Up");
    const json before = rig.atRest();
    REQUIRE(!before.is_null());
    rig.click("pilot anna");
    REQUIRE(rig.await([](const json& s) {
        return s["pilot"]["name"] == "anna" && s["run"]["turns"] > 100 && s["run"]["pictures"] > 2;
    }));
    const json after = rig.state();
    CHECK(after["console"]["forces"] == false);
    CHECK(after["pilot"]["stiffness"] == doctest::Approx(300.0));
    CHECK(apart(before, after) < 0.002);
    CHECK(after["run"]["tool"][1] < -0.04);
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.keyDown("Down");
    REQUIRE(rig.await([](const json& s) { return s["run"]["device"][1] > 0.0; }));
    rig.keyUp("Down");
    rig.xdo("mousemove --window $W 300 300");
    for (int i = 0; i < 32 && rig.state()["run"]["force_N"] < 1.9; ++i) {
        rig.wheel(2);
    }
    REQUIRE(rig.await([](const json& s) { return s["run"]["force_N"] > 1.9; }));
    CHECK(rig.state()["run"]["force_N"] <= 2.0 + 1e-6);
    rig.shoot("pilot");
    rig.key("ctrl+s");
    REQUIRE(rig.awaitNotice("fixtures saved"));
    CHECK(textOf(scene).find("\npilot: \"anna\"\n") != std::string::npos);
    CHECK(rig.close() == 0);
    CHECK(rig.output().find("validation") == std::string::npos);
    const ProgramRun none =
        runFathom({"operate", scene.string(), "--offscreen", "640x480", "--pilot", "carla"});
    CHECK(none.exitCode == 2);
    REQUIRE(none.errorLines().size() == 1);
    CHECK(none.errorLines()[0].find("--pilot: carla (allowed: anna, ben)") != std::string::npos);
}

TEST_CASE("Text size and view are saved in the scene file, and the command line overrides them") {
    WindowRig rig;
    rig.key("ctrl+equal");
    rig.key("ctrl+equal");
    rig.key("Tab");
    REQUIRE(rig.await([](const json& s) {
        return s["console"]["text_scale"] == 1.25 && s["console"]["large"] == "space";
    }));
    rig.key("ctrl+s");
    REQUIRE(rig.awaitNotice("fixtures saved"));
    rig.shoot("large-letters");
    rig.reopen(rig.folder() / "scene.yaml");
    CHECK(rig.state()["console"]["text_scale"] == 1.25);
    CHECK(rig.state()["console"]["large"] == "space");
    rig.reopen(rig.folder() / "scene.yaml", {"--text-scale", "1"});
    CHECK(rig.state()["console"]["text_scale"] == 1.0);
    CHECK(rig.sceneText().find("# a comment that saving must keep") != std::string::npos);
    closeQuietly(rig);
}

TEST_CASE("A class is frozen, released by undo and frozen by redo while frames arrive, also with contacts on "
          "the GPU") {
    WindowRig rig;
    std::ofstream(rig.folder() / "gpu.yaml") << rig.sceneText() << "contact: { where: gpu }\n";
    rig.reopen(rig.folder() / "gpu.yaml");
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 0; }));
    rig.click("box red");
    REQUIRE(rig.await([](const json& s) { return !s["fixtures"][0]["box"].is_null(); }));
    rig.click("hold red");
    const auto held = [](const json& s, bool is) {
        return s["fixtures"][0]["frozen"] == is && s["fixtures"][1]["frozen"] == false;
    };
    REQUIRE(rig.await([&](const json& s) { return held(s, true); }));
    const json first = rig.state();
    rig.drag("box max red", {0.2, 0.5}, {0.0, 0.5}); // a smaller box drops points, unless the class is frozen
    REQUIRE(rig.await([&](const json& s) { return s["fixtures"][0]["box"] != first["fixtures"][0]["box"]; }));
    const int generation = rig.state()["run"]["generation"];
    REQUIRE(rig.await([&](const json& s) { return s["run"]["generation"] > generation + 5; }));
    CHECK(rig.state()["run"]["spheres"] == first["run"]["spheres"]);
    rig.shoot("held");
    rig.click("hold red"); // unfreezes it
    const int all = first["run"]["spheres"];
    REQUIRE(rig.await([&](const json& s) { return held(s, false) && s["run"]["spheres"] < all - 20; }));
    rig.key("ctrl+z");
    REQUIRE(rig.await([&](const json& s) { return held(s, true); }));
    rig.key("ctrl+z"); // undoes the box
    REQUIRE(rig.await([&](const json& s) { return s["fixtures"][0]["box"] == first["fixtures"][0]["box"]; }));
    rig.key("ctrl+z"); // undoes the freeze
    REQUIRE(rig.await([&](const json& s) { return held(s, false) && s["run"]["spheres"] == all; }));
    rig.key("ctrl+y");
    REQUIRE(rig.await([&](const json& s) { return held(s, true); }));
    CHECK(rig.close() == 0);
}

TEST_CASE("The box of a class is dragged smaller, takes effect, is undone and saved") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 0 && s["run"]["turns"] > 100; }));
    const int all = rig.state()["run"]["spheres"];
    rig.click("box red");
    REQUIRE(rig.await([](const json& s) { return !s["fixtures"][0]["box"].is_null(); }));
    const json box = rig.state()["fixtures"][0]["box"];
    const int generation = rig.state()["run"]["generation"];
    REQUIRE(rig.await([&](const json& s) { return s["run"]["generation"] > generation + 3; }));
    CHECK(rig.state()["run"]["spheres"] == all); // the box contains all points
    rig.drag("box max red", {0.2, 0.5}, {0.0, 0.5});
    REQUIRE(rig.await([&](const json& s) {
        return s["fixtures"][0]["box"][1][0].get<double>() < box[1][0].get<double>() - 0.04 &&
               s["run"]["spheres"] < all - 20 && s["run"]["spheres"] > 20;
    }));
    rig.shoot("box");
    rig.key("ctrl+s");
    REQUIRE(rig.awaitNotice("fixtures saved"));
    CHECK(rig.sceneText().find("box: {min: [") != std::string::npos);
    rig.key("ctrl+z");
    REQUIRE(rig.await([&](const json& s) { return s["fixtures"][0]["box"] == box; }));
    rig.key("ctrl+z");
    CHECK(rig.await(
        [&](const json& s) { return s["fixtures"][0]["box"].is_null() && s["run"]["spheres"] == all; }));
    CHECK(rig.close() == 0);
}
