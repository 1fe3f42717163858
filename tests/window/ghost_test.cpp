// SPDX-License-Identifier: Apache-2.0
// What a pick would make before Enter, and new names of fixtures.
#include "tests/window/window_rig.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool isPicked(int r, int g, int b) {
    return std::abs(r - 40) < 24 && std::abs(g - 220) < 24 && std::abs(b - 235) < 24;
}

constexpr Paint3 kGreen{20, 200, 20};
constexpr PixelBox kLeftSquare{4, 36, 14, 44}, kRightSquare{50, 4, 60, 12};

// The rectangle of the window that shows a box of the image, without its border.
std::array<double, 4> insideOf(const WindowRig& rig, const PixelBox& box) {
    const auto camera = rig.place("camera");
    const double pixel = camera[2] / kWidth;
    return {camera[0] + (box.u0 + 1) * pixel, camera[1] + (box.v0 + 1) * pixel, (box.u1 - box.u0 - 2) * pixel,
            (box.v1 - box.v0 - 2) * pixel};
}

// Runs the scene on another image.
void reopenWith(WindowRig& rig, const Image& image) {
    writeRecording(rig.folder() / "other", std::vector<Image>(4, image));
    std::string scene = rig.sceneText();
    scene.replace(scene.find("recorded: recording"), 19, "recorded: other");
    std::ofstream(rig.folder() / "other.yaml") << scene;
    rig.reopen(rig.folder() / "other.yaml");
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 0; }));
}

} // namespace

TEST_CASE("A picked colour shows its final regions before Enter, and warns that they cover the target") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 0; }));
    rig.key("k");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picking"] == true; }));
    rig.click("camera", 9.0 / 64.0, 23.0 / 48.0); // the yellow square, which is also the target
    REQUIRE(rig.await([](const json& s) { return s["console"]["picked"] == true; }));
    REQUIRE(rig.await([](const json& s) { return s["console"]["pick_warnings"].size() == 1; }));
    CHECK(rig.state()["console"]["pick_warnings"][0] == "covers the target 'yellow'");
    const auto camera = rig.place("camera");
    const std::array<double, 4> around{camera[0], camera[1] + 0.2 * camera[3], 0.32 * camera[2],
                                       0.13 * camera[3]}; // above the square, where its spheres reach
    CHECK(rig.shoot("ghost").share(around, isPicked) > 0.008);
    rig.click("role guidance"); // a target has no regions
    REQUIRE(rig.await([](const json& s) { return s["console"]["pick_warnings"].empty(); }));
    CHECK(rig.shoot("ghost-none").share(around, isPicked) < 0.001);
    rig.key("Escape");
    closeQuietly(rig);
}

TEST_CASE("A pick takes only the clicked part, which its boxes for parts and specks change") {
    WindowRig rig;
    Image image = bumpImage();
    image.paint(kLeftSquare, kGreen).paint(kRightSquare, kGreen).paint({62, 20, 64, 22}, kGreen);
    reopenWith(rig, image);
    const auto spheres = rig.state()["run"]["spheres"].get<size_t>();
    rig.key("k");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picking"] == true; }));
    rig.click("camera", 9.0 / 64.0, 40.0 / 48.0);
    REQUIRE(rig.await([](const json& s) { return s["selected"] == 80; }));
    const auto parts = [&] { return rig.state()["console"]["pick_parts"]; };
    CHECK(parts()["parts"] == 3);
    CHECK(parts()["taken"] == 1);
    CHECK(parts()["specks"] == 1);
    Screenshot shot = rig.shoot("parts");
    const auto cyan = [](int r, int g, int b) { return r < 90 && g > 150 && b > 90; }; // over green
    CHECK(shot.share(insideOf(rig, kLeftSquare), cyan) > 0.9);
    CHECK(shot.share(insideOf(rig, kRightSquare), cyan) == 0.0);
    rig.click("only part", 0.1);
    REQUIRE(rig.await([](const json& s) { return s["selected"] == 160; }));
    rig.click("no specks", 0.1);
    REQUIRE(rig.await([](const json& s) { return s["selected"] == 164; }));
    rig.click("only part", 0.1);
    REQUIRE(rig.await([](const json& s) { return s["selected"] == 80; }));
    rig.key("Return");
    REQUIRE(rig.await([&](const json& s) { return s["run"]["spheres"] > spheres; }));
    CHECK(rig.state()["run"]["spheres"].get<size_t>() <= spheres + 80);
    CHECK(rig.state()["fixtures"][2]["box"] != nullptr);
    shot = rig.shoot("parts-added");
    const auto reddish = [](int r, int g, int) { return r > 50 && g < 190; }; // red over green
    CHECK(shot.share(insideOf(rig, kLeftSquare), reddish) > 0.9);
    CHECK(shot.share(insideOf(rig, kRightSquare), reddish) < 0.1);
    closeQuietly(rig);
}

TEST_CASE("A shape is shown at the mouse before the click with what it covers, and then looks like regions") {
    WindowRig rig;
    rig.click("place sphere");
    const auto camera = rig.place("camera");
    const auto pointAt = [&](double u, double v) {
        rig.xdo("mousemove --window $W " + std::to_string(std::lround(camera[0] + u / 64.0 * camera[2])) +
                " " + std::to_string(std::lround(camera[1] + v / 48.0 * camera[3])));
    };
    pointAt(9.0, 23.0);
    REQUIRE(rig.await([](const json& s) { return s["console"]["pick_warnings"].size() == 1; }));
    CHECK(rig.state()["console"]["pick_warnings"][0] == "covers the target 'yellow'");
    pointAt(10.0, 38.0);
    REQUIRE(rig.await([](const json& s) { return s["console"]["pick_warnings"].empty(); }));
    const std::array<double, 4> around = insideOf(rig, {3, 31, 17, 45});
    CHECK(rig.shoot("place-ghost").share(around, isPicked) > 0.01);
    CHECK(rig.state()["shapes"] == 0);
    rig.click("camera", 10.0 / 64.0, 38.0 / 48.0);
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 1; }));
    const Screenshot shot = rig.shoot("placed");
    CHECK(shot.share(around, isPicked) < 0.001);
    const auto tinted = [](int r, int g, int b) {
        return r > g + 20 && r > b + 20;
    }; // red over the grey wall
    CHECK(shot.share(insideOf(rig, {7, 35, 13, 41}), tinted) > 0.9);
    closeQuietly(rig);
}

TEST_CASE("A fixture is renamed in the panel, and undo gives the old name back") {
    WindowRig rig;
    rig.click("rename red");
    REQUIRE(rig.await([](const json& s) { return s["console"]["places"].contains("new name"); }));
    rig.xdo("type --delay 60 valve");
    rig.shoot("rename");
    rig.key("Return");
    REQUIRE(rig.await([](const json& s) { return s["fixtures"][0]["name"] == "valve"; }));
    CHECK(rig.state()["console"]["forces"] == false); // letters are text
    rig.key("ctrl+z");
    CHECK(rig.await([](const json& s) { return s["fixtures"][0]["name"] == "red"; }));
    closeQuietly(rig);
}
