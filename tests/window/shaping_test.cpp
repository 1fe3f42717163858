// SPDX-License-Identifier: Apache-2.0
// Editing fixtures during a run: gates of an active class, lines, boxes.
#include "tests/window/window_rig.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

// The wall, 600 mm away, at the centre of this pixel.
glm::dvec3 wallAtPixel(double u, double v) {
    return 0.6 * glm::dvec3((u - kCx) / kFocal, (v - kCy) / kFocal, 1.0);
}

void clickPixel(const WindowRig& rig, double u, double v) {
    rig.click("camera", (u + 0.5) / kWidth, (v + 0.5) / kHeight);
}

} // namespace

TEST_CASE("The colour of an active class is changed: previewed, applied, undone and redone") {
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["spheres"] > 200; }));
    const auto spheres = rig.state()["run"]["spheres"].get<size_t>();
    rig.click("colour red");
    REQUIRE(rig.await([](const json& s) { return s["console"]["picked"] == true && s["selected"] > 200; }));
    clickPixel(rig, 9, 23); // the yellow square
    REQUIRE(rig.await([](const json& s) { return s["selected"] == 10 * 14; }));
    CHECK(rig.state()["run"]["spheres"].get<size_t>() == spheres); // not active yet
    rig.shoot("gates");
    rig.key("Return");
    REQUIRE(rig.await([&](const json& s) {
        return s["run"]["spheres"] > 0 && s["run"]["spheres"].get<size_t>() <= 10 * 14;
    }));
    CHECK(rig.state()["fixtures"].size() == 2);
    CHECK(rig.state()["fixtures"][0]["name"] == "red"); // name and radius are unchanged
    CHECK(rig.state()["fixtures"][0]["radius"] == 0.04);
    rig.key("ctrl+z");
    REQUIRE(rig.await([&](const json& s) { return s["run"]["spheres"].get<size_t>() == spheres; }));
    rig.key("ctrl+y");
    REQUIRE(rig.await([&](const json& s) { return s["run"]["spheres"].get<size_t>() <= 10 * 14; }));
    closeQuietly(rig);
}

TEST_CASE("A line runs from a first click to a second; a box is placed on the surface and has three edges") {
    WindowRig rig;
    rig.xdo("windowsize --sync $W 1600 900"); // so that the panel has room for all rows
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100 && s["window"]["width"] == 1600; }));
    const auto frames = rig.state()["window"]["frames"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["window"]["frames"] > frames + 4; })); // laid out again
    rig.click("place line");
    clickPixel(rig, 8, 40);
    REQUIRE(rig.awaitNotice("click on its end"));
    CHECK(rig.state()["shapes"] == 0);
    clickPixel(rig, 28, 44);
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 1; }));
    const json line = rig.state()["fixtures"][2];
    CHECK(line["role"] == "guidance");
    const glm::dvec3 direction = glm::normalize(wallAtPixel(28, 44) - wallAtPixel(8, 40));
    CHECK(glm::distance(vec(line["shape"]["at"]), wallAtPixel(8, 40)) < 0.011); // a pixel is 10 mm wide
    CHECK(glm::dot(vec(line["shape"]["axis"]), direction) > 0.99);
    rig.click("place box");
    clickPixel(rig, 54, 8);
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 2; }));
    const json box = rig.state()["fixtures"][3];
    // The normal of the wall, not the direction to the camera, which is 24 degrees off there.
    CHECK(glm::dot(vec(box["shape"]["axis"]), glm::dvec3(0, 0, -1)) > 0.999);
    rig.shoot("shapes");
    rig.click("z box 1", 0.9);
    REQUIRE(rig.await([](const json& s) { return s["fixtures"][3]["shape"]["size"][2] > 0.12; }));
    CHECK(rig.state()["fixtures"][3]["shape"]["size"][0] == 0.1);
    rig.key("ctrl+s");
    REQUIRE(rig.awaitNotice("4 fixtures saved"));
    rig.reopen(rig.folder() / "scene.yaml");
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 2; }));
    CHECK(glm::distance(vec(rig.state()["fixtures"][2]["shape"]["axis"]), vec(line["shape"]["axis"])) < 1e-6);
    closeQuietly(rig);
}
