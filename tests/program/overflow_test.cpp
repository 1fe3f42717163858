// SPDX-License-Identifier: Apache-2.0
// A contact answer that exceeds its capacity, through the whole program.
#include "tests/rig/stage.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE(
    "A tool of so many spheres that a contact answer overflows touches the region and does not penetrate") {
    Stage stage;
    stage.recording({Image(kWidth, kHeight, 150).paint({0, 0, kWidth, kHeight}, kRed)});
    SceneText scene;
    scene.camera = "near: 0.05, far: 3.0";
    scene.contact = "reach: 0.1"; // [m] covers the whole wall
    scene.more = "error_budget: 0\n";
    std::string spheres; // 100 leaves x 3072 region spheres are pairs
    for (int row = 0; row < 10; ++row) {
        for (int column = 0; column < 10; ++column) {
            spheres += std::string(spheres.empty() ? "[" : ", [") + std::to_string(1e-4 * column) + ", " +
                       std::to_string(1e-4 * row) + ", 0, 0.01]";
        }
    }
    scene.tool = "spheres: [" + spheres + "]";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.05}}, {0.2, {0.0, 0.0, 0.15}}, {0.3, {0.0, 0.0, 0.15}}});
    const Replay replay = stage.replay();
    CHECK(replay.summary.at("contact").at("overflows").get<uint64_t>() > 0);
    CHECK(replay.haptic().at("max_penetration_m").get<double>() == 0.0);
    CHECK(replay.ticks.back().state == "contact");
    CHECK(replay.ticks.back().tool.position.z < 0.101); // region from 0.11 m, leaf radius 10 mm
}
