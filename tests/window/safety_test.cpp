// SPDX-License-Identifier: Apache-2.0
// Safety in the window: alarms, forces off, shapes that stop the tool, and explanations.
#include "tests/support/contrast.h"
#include "tests/window/window_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

bool isAdvisory(int r, int g, int b) {
    return std::abs(r - 110) < 24 && std::abs(g - 214) < 24 && std::abs(b - 235) < 24;
}

// Holds a key until the condition is met.
void hold(WindowRig& rig, const std::string& key, const std::function<bool(const glm::dvec3& hand)>& there) {
    rig.keyDown(key);
    CHECK(rig.await([&](const json& s) { return there(vec(s["run"]["device"])); }));
    rig.keyUp(key);
}

// The point of the wall, 600 mm away, at a relative position in the image.
glm::dvec3 wallAt(double u, double v) {
    return 0.6 * glm::dvec3((u * kWidth - 0.5 - kCx) / kFocal, (v * kHeight - 0.5 - kCy) / kFocal, 1.0);
}

// [m] between hand and tool.
double handApart(const json& s) {
    const json &hand = s["run"]["device"], &tool = s["run"]["tool"];
    return std::hypot(hand[0].get<double>() - tool[0].get<double>(),
                      hand[1].get<double>() - tool[1].get<double>(),
                      hand[2].get<double>() - tool[2].get<double>());
}

} // namespace

TEST_CASE("Forces stay off while the hand is inside a region, a card says so, and the clutch brings the hand "
          "to the tool") {
    WindowRig rig;
    rig.push(); // forces are off: the hand moves on, the tool stays outside
    for (int i = 0; i < 40 && handApart(rig.state()) < 0.015; ++i) {
        rig.wheel(2);
    }
    REQUIRE(rig.await([](const json& s) { return handApart(s) > 0.012; }));
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return !s["refusal"].get<std::string>().empty(); }));
    const json refused = rig.state();
    CHECK(refused["refusal"].get<std::string>().find("mm inside 'red': hold C to re-centre") !=
          std::string::npos);
    CHECK(refused["console"]["forces"] == false);
    CHECK(refused["mode"] == "FORCES OFF");
    rig.shoot("refusal");
    CHECK(rig.state()["console"]["places"].contains("refusal"));
    rig.keyDown("c");
    REQUIRE(rig.await([](const json& s) { return handApart(s) < 1e-4; }));
    rig.keyUp("c");
    REQUIRE(!rig.atRest().is_null());
    CHECK(handApart(rig.state()) < 1e-4);
    CHECK(rig.state()["refusal"] == refused["refusal"]); // shown until forces come on, or Esc
    rig.key("a");
    CHECK(rig.await([](const json& s) { return s["console"]["forces"] == true && s["refusal"] == ""; }));
    closeQuietly(rig);
}

TEST_CASE("On screen the state word has a contrast of 7 to 1 while forces are off, on and pressing") {
    WindowRig rig;
    const auto check = [&](const std::string& mode) {
        CAPTURE(mode);
        const Screenshot shot = rig.shoot("contrast-" + mode);
        const auto at = rig.place("mode");
        std::vector<double> light;
        for (auto v = static_cast<uint32_t>(at[1] + 1); v < at[1] + at[3] - 1; ++v) {
            for (auto u = static_cast<uint32_t>(at[0] + 6); u < at[0] + at[2] - 6; ++u) {
                light.push_back(testing::luminance(testing::rgbOf(shot.pixels[v * shot.width + u])));
            }
        }
        REQUIRE(light.size() > 500);
        std::sort(light.begin(), light.end());
        const double plate = light[light.size() / 4], ink = light[light.size() - light.size() / 40];
        CHECK(testing::contrast(ink, plate) >= 7.0);
    };
    check("off");
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    check("on");
    rig.push();
    check("pressed"); // contact, limit, or stale on a busy machine
    closeQuietly(rig);
}

TEST_CASE("An alarm stays until it is acknowledged, and is raised again with its cause") {
    WindowRig rig;
    rig.key("f");
    REQUIRE(rig.await([](const json& s) { return hasAlarm(s, "ADVISORY active frozen"); }));
    rig.click("tab Alarms");
    REQUIRE(rig.await([](const json& s) { return s["console"]["tab"] == 2; }));
    rig.xdo("mousemove --window $W 300 300"); // the tooltip of the tab would cover the list
    REQUIRE(rig.await([](const json& s) { return s["console"]["tooltip"] == ""; }));
    const auto button = rig.place("acknowledge");
    const std::array<double, 4> list{button[0], button[1] + button[3], 330.0, 120.0};
    CHECK(rig.shoot("alarms").share(list, isAdvisory) > 0.0015);
    rig.key("f");
    REQUIRE(rig.await([](const json& s) { return hasAlarm(s, "ADVISORY latched frozen"); }));
    CHECK(rig.state()["alarm_lines"][0] == "ended: Fixtures frozen, new images do not change them");
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 700; }));
    CHECK(hasAlarm(rig.state(), "ADVISORY latched frozen"));
    rig.key("q");
    REQUIRE(rig.await([](const json& s) { return !hasAlarm(s, "frozen"); }));
    CHECK(rig.state()["alarm_lines"].empty());
    rig.key("f");
    REQUIRE(rig.await([](const json& s) { return hasAlarm(s, "ADVISORY active frozen"); }));
    rig.click("acknowledge"); // while the cause lasts: quiet, but shown
    REQUIRE(rig.await([](const json& s) { return hasAlarm(s, "ADVISORY active acknowledged frozen"); }));
    rig.key("f");
    CHECK(rig.await([](const json& s) { return !hasAlarm(s, "frozen"); }));
    closeQuietly(rig);
}

TEST_CASE("An acknowledged alarm stays in the view, dimmed, and goes to the history when it is over") {
    WindowRig rig;
    rig.key("f");
    REQUIRE(rig.await([](const json& s) { return s["console"]["places"].contains("alarm"); }));
    CHECK(rig.state()["alarm_lines"][0] == "Fixtures frozen, new images do not change them: F to release");
    const auto place = rig.place("alarm");
    CHECK(rig.shoot("alarm-line").share(place, isAdvisory) > 0.01);
    rig.key("q");
    REQUIRE(rig.await([](const json& s) { return hasAlarm(s, "active acknowledged frozen"); }));
    CHECK(rig.shoot("alarm-dimmed").share(place, isAdvisory) < 0.001);
    CHECK(rig.state()["console"]["places"].contains("alarm"));
    rig.key("f");
    REQUIRE(rig.await([](const json& s) { return !hasAlarm(s, "frozen"); }));
    CHECK(rig.await([](const json& s) { return !s["console"]["places"].contains("alarm"); }));
    CHECK(rig.state()["alarms_over"][0] == "Fixtures frozen, new images do not change them");
    rig.click("tab Alarms");
    REQUIRE(rig.await([](const json& s) { return s["console"]["tab"] == 2; }));
    rig.shoot("alarm-history");
    closeQuietly(rig);
}

TEST_CASE("The space bar turns forces off during text input, when other keys are text") {
    WindowRig rig;
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.keyDown("ctrl");
    rig.click("radius red");
    rig.keyUp("ctrl");
    rig.key("g"); // typed as text: no guidance
    rig.key("space");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == false; }));
    rig.key("a"); // typed as text: not armed
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 500; }));
    CHECK(rig.state()["console"]["forces"] == false);
    CHECK(rig.state()["console"]["guidance"] == false);
    CHECK(rig.state()["run"]["force_N"] == 0.0);
    rig.key("Escape"); // leaves the text field
    const auto frames = rig.state()["window"]["frames"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["window"]["frames"] > frames + 3; }));
    rig.key("a");
    CHECK(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    closeQuietly(rig);
}

TEST_CASE("A shape placed by a click stops the tool, and undo releases it") {
    constexpr double kU = 0.2, kV = 0.2, kRadius = 0.05, kLeaf = 0.01;
    WindowRig rig;
    REQUIRE(rig.await([](const json& s) { return s["run"]["turns"] > 100; }));
    rig.click("place sphere");
    rig.click("camera", kU, kV);
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 1; }));
    CHECK(rig.state()["fixtures"].size() == 3);
    const glm::dvec3 centre = wallAt(kU, kV);
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    hold(rig, "Left", [&](const glm::dvec3& hand) { return hand.x < centre.x + 0.01; });
    hold(rig, "Up", [&](const glm::dvec3& hand) { return hand.y < centre.y + 0.01; });
    hold(rig, "Page_Up", [&](const glm::dvec3& hand) { return hand.z > centre.z - 0.04; });
    REQUIRE(rig.await([](const json& s) { return s["run"]["contacts"] > 0 && s["run"]["force_N"] > 0.5; }));
    const json stopped = rig.state();
    const double apart = glm::distance(vec(stopped["run"]["tool"]), centre);
    CHECK(apart > kRadius + kLeaf - 0.012); // a pixel is 10 mm wide
    CHECK(apart < kRadius + kLeaf + 0.012);
    CHECK(glm::distance(vec(stopped["run"]["device"]), centre) < apart - 0.005); // the hand moved on
    CHECK(stopped["why"].get<std::string>().find("'sphere 1', a placed shape") != std::string::npos);
    rig.key("w");
    REQUIRE(rig.await([](const json& s) { return s["console"]["tab"] == 1; }));
    rig.shoot("shape");
    rig.key("ctrl+z");
    REQUIRE(rig.await([](const json& s) { return s["shapes"] == 0; }));
    CHECK(rig.await(
        [](const json& s) { return glm::distance(vec(s["run"]["tool"]), vec(s["run"]["device"])) < 0.001; }));
    closeQuietly(rig);
}

TEST_CASE("Pointing at the contact shows class, region sphere, depth and frame; elsewhere nothing") {
    WindowRig rig;
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["run"]["contacts"] > 0 && s["run"]["force_N"] > 0.2; }));
    REQUIRE(!rig.atRest().is_null());
    const auto at = rig.place("contact");
    const auto beside = [&](double x, double y) {
        return std::array<double, 4>{at[0] + x, at[1] + y, 260.0, 40.0};
    };
    rig.xdo("mousemove --window $W 300 80");
    REQUIRE(rig.await([](const json& s) { return s["hovered"] == ""; }));
    const auto dark = [](int r, int g, int b) { return r < 40 && g < 40 && b < 50; };
    const double before = rig.shoot("no-hover").share(beside(30, 24), dark);
    rig.xdo("mousemove --window $W " + std::to_string(std::lround(at[0] + 3)) + " " +
            std::to_string(std::lround(at[1] + 3)));
    REQUIRE(rig.await([](const json& s) { return s["hovered"] != ""; }));
    const auto words = rig.state()["hovered"].get<std::string>();
    for (const char* part : {"'red'", "region sphere of pixel (", "mm beyond", "since frame"}) {
        CAPTURE(part);
        CHECK(words.find(part) != std::string::npos);
    }
    CHECK(rig.shoot("hover").share(beside(30, 24), dark) > before + 0.4);
    rig.xdo("mousemove --window $W 300 80");
    CHECK(rig.await([](const json& s) { return s["hovered"] == ""; }));
    closeQuietly(rig);
}
