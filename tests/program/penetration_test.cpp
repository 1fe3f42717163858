// SPDX-License-Identifier: Apache-2.0
// Recomputes the penetration from the saved sets and the tool poses of haptics.csv alone: every leaf against
// every sphere of the active set. A leaf may stay as deep as it was when a new set covered it, never deeper.
#include "tests/rig/stage.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;

namespace {

struct Leaf {
    dvec3 centre; // tool frame [m]
    double radius;
};

struct Depths {
    double beyond = 0.0, inside = 0.0; // [m] largest depth beyond the allowance, and within it
    size_t touched = 0;                // pairs that overlap when their set becomes active
};

double depthOf(const Leaf& leaf, const Pose& tool, const SavedSphere& sphere) {
    return std::max(0.0, leaf.radius + sphere.radius - glm::length(tool.apply(leaf.centre) - sphere.centre));
}

Depths recompute(const Replay& replay, const std::vector<Leaf>& leaves) {
    Depths depths;
    std::vector<SavedSphere> set;
    std::vector<double> allowance;
    int frame = -1;
    Pose start = replay.ticks.front().tool; // the first tick stays there, in free space
    for (const Tick& tick : replay.ticks) {
        if (tick.frame >= 0 && tick.frame != frame) {
            frame = tick.frame;
            set = readPly(replay.ply(frame));
            allowance.assign(leaves.size() * set.size(), 0.0);
            for (size_t pair = 0; pair < allowance.size(); ++pair) {
                allowance[pair] = depthOf(leaves[pair / set.size()], start, set[pair % set.size()]);
                depths.touched += allowance[pair] > 0.0;
            }
        }
        for (size_t pair = 0; pair < allowance.size(); ++pair) {
            const double depth = depthOf(leaves[pair / set.size()], tick.tool, set[pair % set.size()]);
            depths.beyond = std::max(depths.beyond, depth - allowance[pair]);
            allowance[pair] = std::min(allowance[pair], depth);
            depths.inside = std::max(depths.inside, allowance[pair]);
        }
        start = tick.tool;
    }
    return depths;
}

void checkPromise(const Replay& replay, const std::vector<Leaf>& leaves, Depths& depths) {
    depths = recompute(replay, leaves);
    CHECK(depths.beyond <= 1e-5);
    CHECK(std::abs(depths.beyond - replay.haptic().at("max_penetration_m").get<double>()) <= 1e-9);
    CHECK(std::abs(depths.inside - replay.haptic().at("max_escape_depth_m").get<double>()) <= 1e-9);
}

const std::vector<Leaf> kGripper{
    {{0.0, 0.0, 0.0}, 0.010}, {{0.02, 0.0, -0.01}, 0.008}, {{0.0, 0.015, -0.03}, 0.012}};
constexpr const char* kGripperText =
    "spheres: [[0, 0, 0, 0.01], [0.02, 0, -0.01, 0.008], [0, 0.015, -0.03, 0.012]]";

} // namespace

TEST_CASE("A tool pushed, dragged and rotated over a bump never enters a sphere of the active set") {
    Stage stage;
    std::vector<Image> images;
    for (uint32_t i = 0; i < 12; ++i) {
        images.push_back(bumpImage().set({30 + i % 3, 20, 32 + i % 3, 22}, 0)); // a hole that flickers
    }
    stage.recording(images);
    SceneText scene;
    scene.tool = kGripperText;
    stage.scene(scene);
    stage.hand({{0.0, {-0.01, 0.0, 0.44}},
                {0.1, {-0.01, 0.0, 0.52}},
                {0.3, {0.03, 0.01, 0.55}, {0.9689, 0.2474, 0.0, 0.0}}, // rotated by 0.5 rad about x
                {0.5, {0.0, -0.03, 0.53}, {0.9689, 0.0, -0.2474, 0.0}},
                {0.6, {0.0, 0.0, 0.44}}});
    const Replay replay = stage.replay({"--save-fixtures"});
    Depths depths;
    checkPromise(replay, kGripper, depths);
    CHECK(replay.haptic().at("max_force_N").get<double>() > 15.0); // so it pushed
    CHECK(replay.haptic().at("max_torque_Nm").get<double>() > 1e-3);
}

TEST_CASE("A region that appears over the tool lets it out slowly and never deeper than it was") {
    Stage stage;
    // The whole wall turns red under a tool 30 mm in front of it, which is then 20 mm deep in the new region.
    // Later the wall steps towards the tool and back.
    const PixelBox all{0, 0, kWidth, kHeight};
    std::vector<Image> images{{kWidth, kHeight, 600}, {kWidth, kHeight, 600}};
    for (int i = 0; i < 4; ++i) {
        images.push_back(Image(kWidth, kHeight, 600).paint(all, kRed));
    }
    for (int i = 0; i < 3; ++i) {
        images.push_back(Image(kWidth, kHeight, 590).paint(all, kRed));
    }
    stage.recording(images);
    SceneText scene;
    scene.tool = kGripperText;
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.57}}, {0.4, {0.0, 0.0, 0.57}}});
    const Replay replay = stage.replay({"--save-fixtures"});
    Depths depths;
    checkPromise(replay, kGripper, depths);
    CHECK(depths.touched > 50);
    CHECK(depths.inside > 0.015);
    CHECK(replay.haptic().at("escape_ticks").get<int>() >= 20); // 20 mm at 1 mm per tick
    for (size_t i = 1; i < replay.ticks.size(); ++i) {
        const Tick &before = replay.ticks[i - 1], &now = replay.ticks[i];
        CAPTURE(now.t);
        CHECK(glm::length(now.tool.position - before.tool.position) < 0.0025); // no jump
        if (now.state == "escape" && before.frame == now.frame) {
            CHECK(now.minGap >= before.minGap - 1e-9);
        }
    }
    CHECK(replay.at(0.19).minGap > -1e-6); // outside again before the step
    CHECK(replay.ticks.back().minGap > -1e-6);
}

TEST_CASE("There is no penetration with late answers and a reach so short that the tool stalls") {
    Stage stage;
    stage.recording({bumpImage(), bumpImage().dome({26, 16, 42, 32}, 12.0), bumpImage(), bumpImage()});
    SceneText scene;
    scene.tool = kGripperText;
    scene.contact = "reach: 0.004, delay: 20";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.44}},
                {0.06, {0.01, 0.0, 0.53}},
                {0.15, {-0.02, 0.01, 0.54}},
                {0.25, {-0.02, 0.01, 0.54}},
                {0.3, {0.0, 0.0, 0.44}}});
    const Replay replay = stage.replay({"--save-fixtures"});
    Depths depths;
    checkPromise(replay, kGripper, depths);
    CHECK(replay.haptic().at("stalled_ticks").get<int>() > 5);
    CHECK(replay.haptic().at("max_force_N").get<double>() > 5.0);
}
