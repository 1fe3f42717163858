// SPDX-License-Identifier: Apache-2.0
// Scenes with placed shapes only, tools of one to a thousand leaves, and a distant base frame.
#include "tests/rig/stage.h"
#include "tests/support/mentions.h"

#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <sstream>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kLeaf = 0.01; // [m] radius of the only leaf, at the tool's origin

// Replays a scene with this one shape and a hand that tries to enter it. gap(centre) is the exact clearance
// of the leaf.
Replay tryShape(const std::string& row, const std::vector<HandRow>& hand,
                const std::function<double(const dvec3&)>& gap) {
    Stage stage;
    stage.recording({bumpImage(), bumpImage()});
    SceneText scene;
    scene.fixtures = {row};
    stage.scene(scene);
    stage.hand(hand);
    const Replay replay = stage.replay({"--save-fixtures"});
    double least = 1.0;
    for (const Tick& tick : replay.ticks) {
        least = std::min(least, gap(tick.tool.position));
    }
    CHECK(least > -1e-5);
    CHECK(least < 1e-4); // it touched the shape
    CHECK(replay.haptic().at("max_force_N").get<double>() > 5.0);
    // Nothing is needed from the frame: no pass, no sphere, no query.
    CHECK(replay.timeColumns == std::vector<std::string>{"upload_ms", "publish_ms", "answerable_ms"});
    CHECK(replay.summary.at("contact").at("where") == "none");
    CHECK(replay.frames.at(0).spheres == 0);
    CHECK(readPly(replay.ply(0)).empty());
    return replay;
}

} // namespace

TEST_CASE("A forbidden box keeps the tool outside its faces, edges and corners") {
    const auto gap = [](const dvec3& p) {
        const dvec3 beyond = glm::max(glm::abs(p - dvec3(0.0, 0.0, 0.6)) - dvec3(0.1), dvec3(0.0));
        return glm::length(beyond) - kLeaf;
    };
    const Replay replay = tryShape(
        "name: box, role: forbidden, shape: box, base_T_shape: {xyz: [0, 0, 0.6]}, size: [0.2, 0.2, 0.2]",
        {{0.0, {0.0, 0.0, 0.45}},
         {0.2, {0.0, 0.0, 0.51}},
         {0.6, {0.105, 0.105, 0.51}},
         {0.9, {0.12, 0.12, 0.6}}},
        gap);
    CHECK(replay.summary.at("fixtures").at(0).at("role") == "forbidden");
}

TEST_CASE("A forbidden plane keeps the tool on its side") {
    // The half-space z <= 0 of the shape, rotated: everything beyond z = 0.5 is forbidden.
    tryShape("name: wall, role: forbidden, shape: plane, base_T_shape: {xyz: [0, 0, 0.5], quat_xyzw: [1, 0, "
             "0, 0]}",
             {{0.0, {0.0, 0.0, 0.45}}, {0.2, {0.0, 0.0, 0.51}}, {0.4, {0.1, 0.05, 0.505}}},
             [](const dvec3& p) { return 0.5 - p.z - kLeaf; });
}

TEST_CASE("A keep_in sphere keeps the tool inside") {
    const Replay replay = tryShape(
        "name: bowl, role: keep_in, shape: sphere, base_T_shape: {xyz: [0, 0, 0.5]}, size: [0.1, 0, 0]",
        {{0.0, {0.0, 0.0, 0.5}}, {0.3, {0.08, 0.0, 0.57}}, {0.6, {-0.05, 0.09, 0.5}}},
        [](const dvec3& p) { return 0.1 - kLeaf - glm::length(p - dvec3(0.0, 0.0, 0.5)); });
    CHECK(replay.summary.at("fixtures").at(0).at("role") == "keep_in");
}

TEST_CASE("A forbidden cylinder keeps the tool off its side") {
    tryShape("name: pipe, role: forbidden, shape: cylinder, base_T_shape: {xyz: [0, 0, 0.6], quat_xyzw: [0, "
             "0.7071067811865476, 0, "
             "0.7071067811865476]}, size: [0.05, 0.4, 0]", // the axis along x
             {{0.0, {0.0, 0.0, 0.52}}, {0.2, {0.02, 0.0, 0.556}}, {0.5, {0.05, 0.06, 0.58}}},
             [](const dvec3& p) { return std::hypot(p.y, p.z - 0.6) - 0.05 - kLeaf; });
}

TEST_CASE("The plan and the log of a replay name a shape that the tool starts on the wrong side of") {
    Stage stage;
    stage.recording({bumpImage(), bumpImage()});
    SceneText scene;
    scene.hand = "path: hand.csv";
    scene.fixtures = {
        "name: box, role: forbidden, shape: box, base_T_shape: {xyz: [0, 0, 0.6]}, size: [0.2, 0.2, 0.2]",
        "name: bowl, role: keep_in, shape: sphere, base_T_shape: {xyz: [0, 0, 0.9]}, size: [0.2, 0, 0]"};
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.6}}, {0.1, {0.0, 0.0, 0.6}}});
    const ProgramRun plan =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    const ProgramRun run = runFathom(stage.command());
    CHECK(run.exitCode == 0);
    for (const char* line : {"fixture 'box': the tool starts 110 mm inside of it and is moved out; the hand "
                             "feels up to the force limit\n",
                             "fixture 'bowl': the tool starts 110 mm outside of it and is moved in; the hand "
                             "feels up to the force limit\n"}) {
        mentions(plan.out, "warning " + std::string(line));
        mentions(run.err, "warning: " + std::string(line));
    }
}

TEST_CASE("A line lets the tool move along it only") {
    const Replay replay =
        tryShape("name: rail, role: guidance, shape: line, base_T_shape: {xyz: [0, 0, 0.5], quat_xyzw: [0, "
                 "0.7071067811865476, 0, 0.7071067811865476]}", // along x
                 {{0.0, {0.0, 0.0, 0.5}}, {0.2, {0.05, 0.01, 0.505}}, {0.4, {0.1, -0.01, 0.49}}},
                 [](const dvec3& p) { return 1e-6 - std::hypot(p.y, p.z - 0.5); });
    CHECK(replay.ticks.back().tool.position.x == doctest::Approx(0.1).epsilon(0.01));
}

TEST_CASE("A tool of a thousand leaves from a .sph file runs, with the same digest for CPU and GPU query") {
    Stage stage;
    stage.recording({bumpImage(), bumpImage()});
    std::ostringstream sph;
    sph << "2 1000\n0 0 0 0.05\n";
    for (int i = 0; i < 1000; ++i) {
        const int row = i / 10 % 10, layer = i / 100;
        sph << 0.004 * (i % 10 - 4.5) << " " << 0.004 * (row - 4.5) << " " << 0.004 * (layer - 9)
            << " 0.003\n";
    }
    stage.write("block.sph", sph.str());
    SceneText scene;
    scene.tool = "file: block.sph";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.45}},
                {0.15, {0.0, 0.0, 0.52}},
                {0.25, {0.02, 0.0, 0.52}, {0.995, 0.0998, 0.0, 0.0}}});
    const Replay cpu = stage.replay({"--query", "cpu"}, {}, "cpu"),
                 gpu = stage.replay({"--query", "gpu"}, {}, "gpu");
    CHECK(cpu.haptic().at("max_force_N").get<double>() > 5.0);
    CHECK(cpu.summary.at("contact").at("spheres_max").get<int>() > 50);
    CHECK(cpu.summary.at("digest") == gpu.summary.at("digest"));
}

TEST_CASE(
    "A base frame 100 km away gives the same forces except for the rounding of float64 positions there") {
    Stage stage;
    stage.recording({bumpImage(), bumpImage()});
    const auto runAt = [&](const dvec3& base, const std::string& out) {
        SceneText scene;
        std::ostringstream camera;
        camera << "near: 0.1, far: 3.0, base_T_camera: {xyz: [" << base.x << ", " << base.y << ", " << base.z
               << "]}";
        scene.camera = camera.str();
        scene.tool = "spheres: [[0.01, 0, 0, 0.01], [0, 0, -0.02, 0.012]]";
        scene.haptics = "friction: 0.1";
        stage.scene(scene);
        std::vector<HandRow> rows{
            {0.0, {0.0, 0.0, 0.4375}}, {0.25, {0.0, 0.0, 0.515625}}, {0.5, {0.015625, 0.0, 0.515625}}};
        for (HandRow& row : rows) { // binary fractions, so that adding the base offset is exact
            row.at = {row.at[0] + base.x, row.at[1] + base.y, row.at[2] + base.z};
        }
        stage.hand(rows);
        return stage.replay({}, {}, out);
    };
    const Replay here = runAt(dvec3(0.0), "here"), there = runAt(dvec3(100000.0, -50000.0, 20000.0), "there");
    REQUIRE(here.ticks.size() == there.ticks.size());
    CHECK(here.haptic().at("max_force_N").get<double>() > 5.0);
    double worst = 0.0;
    for (size_t i = 0; i < here.ticks.size(); ++i) {
        worst = std::max({worst, glm::length(here.ticks[i].force - there.ticks[i].force),
                          glm::length(here.ticks[i].torque - there.ticks[i].torque)});
    }
    MESSAGE("largest difference: ", worst, " N or N m");
    // A position 1e5 m away is rounded to 1.5e-11 m, which 1000 N/m turn into 1.5e-8 N; each tick corrects
    // the error of those before it. Without friction the error along the surface stays: measured 7e-5 N.
    CHECK(worst < 1e-6);
}

TEST_CASE(
    "A realtime replay of shapes alone does not wait until the simulated camera has rendered all frames") {
    Stage stage;
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.2, {0.0, 0.0, 0.4}}});
    SceneText scene;
    scene.camera = "source: {simulated: tank, frames: 240}";
    scene.fixtures = {"name: wall, role: forbidden, shape: plane, base_T_shape: {xyz: [0, 0, -1]}"};
    stage.scene(scene);
    const ProgramRun run = runFathom(stage.command({"--realtime", "--frame-rate", "240"}));
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    CHECK(nlohmann::json::parse(stage.read("out/summary.json")).at("frames").at("count") == 240);
    CHECK(run.err.find("has rendered its") == std::string::npos); // a notice of runs that render them all
}
