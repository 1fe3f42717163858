// SPDX-License-Identifier: Apache-2.0
// Pilots, the window's settings and the water's colour in a scene file.
#include "tests/scene/scene_file.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

Scene load(const std::string& more) {
    const SceneFile file(kMinimal + more);
    return loadScene(file.path());
}

const std::string kTwo = "haptics: {stiffness: 500, limits: {force: 9, slew_N_per_s: 900}}\n"
                         "hand: {map: {scale: 0.8}}\n"
                         "pilots:\n"
                         "  - {name: anna, stiffness: auto, limits: {force: 3}, scale: 0.5}\n"
                         "  - {name: ben, rotational_stiffness: 0.7, guidance_pull: {force: 1, torque: 0}}\n";

} // namespace

TEST_CASE("A pilot has the scene's haptics with the given overrides, and the first pilot is active") {
    const Scene scene = load(kTwo);
    REQUIRE(scene.pilots.size() == 2);
    CHECK(scene.pilot == "anna");
    CHECK_FALSE(scene.haptics.stiffness.has_value());
    CHECK(scene.haptics.forceLimit == 3.0);
    CHECK(scene.haptics.slewForce == 900.0);
    CHECK(scene.hand.scale == 0.5);
    Scene ben = scene;
    REQUIRE(ben.choosePilot("ben"));
    CHECK(ben.haptics.stiffness == 500.0);
    CHECK(ben.haptics.rotationalStiffness == 0.7);
    CHECK(ben.haptics.forceLimit == 9.0);
    CHECK(ben.haptics.pullForce == 1.0);
    CHECK(ben.haptics.pullTorque == 0.0);
    CHECK(ben.hand.scale == 0.8);
    CHECK_FALSE(ben.choosePilot("carla"));
    CHECK(ben.pilot == "ben");
    CHECK(load(kTwo + "pilot: ben\n").hand.scale == 0.8);
}

TEST_CASE("A scene without pilots has no active pilot") {
    const Scene scene = load("");
    CHECK(scene.pilots.empty());
    CHECK(scene.pilot.empty());
    CHECK_FALSE(scene.window.has_value());
    CHECK_FALSE(scene.attenuation.has_value());
}

TEST_CASE("Window settings and attenuation are read") {
    const Scene scene = load("window: {text_scale: 1.25, large: space, yaw: -7, pitch: 0.1, distance: 2, "
                             "layout: pilot, tones: false}\n"
                             "camera: {attenuation: [0.6, 0.1, 0.05]}\n");
    REQUIRE(scene.window.has_value());
    CHECK(scene.window->textScale == 1.25);
    CHECK(scene.window->spaceIsLarge);
    CHECK(scene.window->pilotLayout);
    CHECK_FALSE(scene.window->tones);
    CHECK(load("window: {pitch: 1.5708}\n").window->pitch == 1.5708); // from above, as it is saved
    CHECK(scene.window->yaw == -7.0);
    CHECK(scene.attenuation == dvec3(0.6, 0.1, 0.05));
}

TEST_CASE("Invalid pilots, settings and water are rejected in one line") {
    const std::pair<std::string, std::string> bad[] = {
        {"pilots: []\n", "pilots: 0 pilots"},
        {"pilots: [{stiffness: 3}]\n", "pilots[0].name"},
        {"pilots: [{name: a}, {name: a}]\n", "pilots[1].name: a"},
        {"pilots: [{name: a, stiffness: -1}]\n", "pilots[0].stiffness: -1"},
        {"pilots: [{name: a, stifness: 1}]\n", "pilots[0].stifness"},
        {"pilots: [{name: a, scale: 0}]\n", "pilots[0].scale: 0"},
        {"pilots: [{name: a, guidance_pull: {force: -1}}]\n", "pilots[0].guidance_pull.force: -1"},
        {"pilots: [{name: a}]\npilot: b\n", "pilot: b (allowed: a)"},
        {"pilot: b\n", "pilot: b (allowed: none"},
        {"window: {text_scale: 3}\n", "window.text_scale: 3"},
        {"window: {large: both}\n", "window.large: both"},
        {"window: {layout: wide}\n", "window.layout: wide"},
        {"window: {tones: loud}\n", "window.tones: loud"},
        {"window: {pitch: 1.6}\n", "window.pitch: 1.6"},
        {"camera: {attenuation: [1, 2]}\n", "camera.attenuation"},
        {"camera: {attenuation: [-1, 0, 0]}\n", "camera.attenuation"},
    };
    for (const auto& [text, words] : bad) {
        const std::string message = refusal(kMinimal + text);
        CAPTURE(message);
        CHECK(message.find("scene.yaml: " + words) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
}
