// SPDX-License-Identifier: Apache-2.0
// The hand: its map with scale, rotation and clutch, the closed loop of --hand, dead-man, and both guidance
// modes.
#include "tests/rig/stage.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;

namespace {

const PixelBox kAll{0, 0, kWidth, kHeight};

// A red wall 600 mm away. A leaf of 10 mm meets its region of 40 mm just before z = 0.55.
void redWall(const Stage& stage, size_t frames = 1) {
    stage.recording(std::vector<Image>(frames, Image(kWidth, kHeight, 600).paint(kAll, kRed)));
}

dvec3 vectorOf(const nlohmann::json& list) {
    return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

// A yellow square on a grey wall. The hand waits 0.3 m in front of it and requests guidance from 0.1 s to 1.0
// s.
Replay guided(Stage& stage, const std::string& mode) {
    stage.recording({bumpImage(), bumpImage()});
    SceneText scene;
    scene.fixtures = {SceneText::kGuideYellow};
    scene.haptics = "guidance: " + mode;
    stage.scene(scene);
    stage.hand({{0.0, {0.02, 0.0, 0.3}},
                {0.1, {0.02, 0.0, 0.3}, {1, 0, 0, 0}, 1},
                {1.0, {0.02, 0.0, 0.3}},
                {1.8, {0.02, 0.0, 0.3}}});
    const Replay replay = stage.replay();
    CHECK(replay.at(0.099).guidance == 0.0);
    for (const Tick& tick : replay.ticks) {
        CAPTURE(tick.t);
        CHECK(glm::length(tick.force) <= 2.0 + 1e-9);
        if (tick.t >= 0.65 && tick.t < 0.999) {
            CHECK(tick.guidance == doctest::Approx(1.0));
        }
        if (tick.t >= 1.55) {
            CHECK(tick.guidance == 0.0);
            CHECK(glm::length(tick.force) < 1e-9);
        }
    }
    const Tick& full = replay.at(0.9);
    const dvec3 target = vectorOf(replay.summary.at("guidance").at(0).at("target_m"));
    CHECK(glm::length(full.force) ==
          doctest::Approx(2.0).epsilon(1e-3)); // far from the target, so at the limit
    CHECK(glm::dot(glm::normalize(full.force), glm::normalize(target - full.device.position)) > 0.9999);
    return replay;
}

} // namespace

TEST_CASE("The hand map rotates and scales the hand's path, and multiplies the stiffness by as much as it "
          "scales down") {
    Stage stage;
    redWall(stage);
    SceneText scene;
    scene.hand =
        "map: {base_R_device: [0, 0, 0.7071067811865476, 0.7071067811865476], scale: 0.5}"; // x maps to y
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.8}}, {0.2, {0.06, 0.02, 0.9}}});
    const Replay replay = stage.replay();
    const Tick& tick = replay.at(0.1);
    CHECK(glm::length(tick.device.position - dvec3(-0.005, 0.015, 0.425)) < 1e-9);
    CHECK(replay.haptic().at("stiffness_N_per_m").get<double>() == doctest::Approx(960.0));
}

TEST_CASE("The clutch re-indexes the hand without moving the tool, and ramps the force down and up again") {
    Stage stage;
    redWall(stage);
    SceneText scene;
    scene.hand = "map: {scale: 0.5, clutch: 8}";
    stage.scene(scene);
    // In contact from 0.2 s on. The clutch is down from 0.3 s to 0.7 s while the hand moves far away.
    stage.hand({{0.0, {0.0, 0.0, 1.0}},
                {0.2, {0.0, 0.0, 1.11}},
                {0.3, {0.0, 0.0, 1.11}, {1, 0, 0, 0}, 8},
                {0.7, {0.3, -0.2, 0.9}},
                {1.0, {0.3, -0.2, 0.9}},
                {1.2, {0.34, -0.2, 0.9}}});
    const Replay replay = stage.replay();
    const Tick &before = replay.at(0.299), &down = replay.at(0.6), &after = replay.at(0.99),
               &moved = replay.ticks.back();
    CHECK(before.force.z < -4.0);
    CHECK(glm::length(down.force) == 0.0);
    CHECK(glm::length(down.device.position - before.device.position) < 1e-12);
    CHECK(glm::length(down.tool.position - before.tool.position) < 1e-6);
    CHECK(glm::length(after.device.position - before.device.position) < 1e-12);
    CHECK(glm::length(after.force - before.force) < 1e-3);
    CHECK(moved.device.position.x == doctest::Approx(before.device.position.x + 0.02).epsilon(0.01));
    for (size_t i = 1; i < replay.ticks.size(); ++i) {
        CHECK(glm::length(replay.ticks[i].force - replay.ticks[i - 1].force) <=
              2000.0 / 1000.0 + 1e-9); // slew limit
    }
}

TEST_CASE("With --hand the force pushes the hand back: at rest its spring and the coupling balance") {
    Stage stage;
    redWall(stage);
    SceneText scene;
    scene.hand = "loop: {mass: 0.2, damping: 6, stiffness: 300}";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.50}}, {0.5, {0.0, 0.0, 0.57}}, {2.0, {0.0, 0.0, 0.57}}});
    const Replay open = stage.replay({}, {}, "open");
    const Replay closed = stage.replay({"--hand"}, {1000.0, 20.0, 2.0, false}, "closed");
    const Tick &last = closed.ticks.back(), &free = open.ticks.back();
    CHECK(free.device.position.z == doctest::Approx(0.57));
    CHECK(free.force.z == doctest::Approx(-480.0 * (0.57 - free.tool.position.z)));
    CHECK(last.force.z < -3.0);
    CHECK(300.0 * (0.57 - last.device.position.z) + last.force.z == doctest::Approx(0.0).epsilon(0.02));
    // Two springs in series share the distance between path and wall.
    const double squeezed = 0.57 - last.tool.position.z;
    CHECK(last.device.position.z - last.tool.position.z ==
          doctest::Approx(squeezed * 300.0 / 780.0).epsilon(0.02));
    CHECK(open.summary.at("digest") != closed.summary.at("digest"));
    const Replay again = stage.replay({"--hand", "--query", "gpu"}, {1000.0, 20.0, 2.0, false}, "again");
    CHECK(again.summary.at("digest") == closed.summary.at("digest"));
}

TEST_CASE("An open dead-man takes the force away within 0.2 s while the tool still obeys the region") {
    Stage stage;
    redWall(stage);
    stage.hand({{0.0, {0.0, 0.0, 0.5}},
                {0.2, {0.0, 0.0, 0.56}},
                {0.3, {0.0, 0.0, 0.56}, {1, 0, 0, 0}, 2},
                {0.6, {0.0, 0.0, 0.57}},
                {0.9, {0.0, 0.0, 0.57}}});
    const Replay replay = stage.replay();
    CHECK(replay.at(0.299).force.z < -4.0);
    CHECK(replay.at(0.299).state == "contact");
    CHECK(replay.at(0.35).state == "fading");
    CHECK(replay.at(0.52).state == "off");
    CHECK(glm::length(replay.at(0.52).force) == 0.0);
    CHECK(replay.at(0.52).tool.position.z < 0.551);
    CHECK(replay.ticks.back().force.z < -7.0);
}

TEST_CASE("Guidance as a target leads the tool towards it, by at most 2 N of the spring") {
    Stage stage;
    const Replay replay = guided(stage, "target");
    double farthest = 0.0;
    for (const Tick& tick : replay.ticks) {
        farthest = std::max(farthest, glm::length(tick.tool.position - tick.device.position));
    }
    CHECK(farthest == doctest::Approx(2.0 / 480.0).epsilon(1e-3));
    CHECK(replay.haptic().at("stiffness_N_per_m").get<double>() == doctest::Approx(480.0));
}

TEST_CASE("Guidance as in the paper pulls the hand and leaves the tool where the hand is") {
    Stage stage;
    const Replay replay = guided(stage, "paper");
    for (const Tick& tick : replay.ticks) {
        CHECK(glm::length(tick.tool.position - tick.device.position) < 1e-9);
    }
    CHECK(replay.haptic().at("stiffness_N_per_m").get<double>() < 479.0); // both springs share the bound
}

TEST_CASE("Guidance to a target inside a forbidden region leads to its border and not through it") {
    Stage stage;
    stage.recording({Image(kWidth, kHeight, 600).paint(kAll, kRed).paint({30, 22, 34, 26}, kYellow)});
    SceneText scene;
    scene.fixtures = {SceneText::kForbidRed, SceneText::kGuideYellow};
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.50}},
                {0.3, {0.0, 0.0, 0.549}, {1, 0, 0, 0}, 1},
                {1.2, {0.0, 0.0, 0.56}, {1, 0, 0, 0}, 1}});
    const Replay replay = stage.replay();
    CHECK(replay.ticks.back().guidance == doctest::Approx(1.0));
    CHECK(replay.ticks.back().contacts > 0);
    CHECK(replay.ticks.back().tool.position.z < 0.56);
}

TEST_CASE("A device preset limits force and torque, and the summary reports the preset's values") {
    Stage stage;
    redWall(stage);
    SceneText scene;
    scene.haptics = "device: w5d";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.5}}, {0.2, {0.0, 0.0, 0.58}}, {0.4, {0.0, 0.0, 0.58}}});
    const Replay preset = stage.replay({}, {1000.0, 8.0, 0.2}, "preset");
    CHECK(preset.haptic().at("max_force_N").get<double>() == doctest::Approx(8.0));
    CHECK(preset.haptic().at("margin_passive_min").is_null()); // the damping b of the real device is unknown
    scene.haptics = "device: w5d, limits: {force: 3}, stiffness: 500";
    stage.scene(scene);
    const Replay lower = stage.replay({}, {1000.0, 3.0, 0.2}, "lower");
    CHECK(lower.haptic().at("max_force_N").get<double>() == doctest::Approx(3.0));
    CHECK(lower.haptic().at("stiffness_N_per_m").get<double>() == doctest::Approx(500.0));
}
