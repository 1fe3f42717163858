// SPDX-License-Identifier: Apache-2.0
// The output of `replay --out`: files, keys, columns and counts. Equal runs give identical files.
#include "tests/rig/stage.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;

namespace {

// Down onto the red bump, whose top is 540 mm away and whose region begins at 500 mm, and up again.
const std::vector<HandRow> kPush{
    {0.0, {0.0, 0.0, 0.45}}, {0.2, {0.0, 0.0, 0.50}}, {0.3, {0.004, 0.0, 0.50}}, {0.5, {0.0, 0.0, 0.44}}};

// A scene with a bump, a shape and guidance.
SceneText fullScene() {
    SceneText scene;
    scene.fixtures = {
        SceneText::kForbidRed, SceneText::kGuideYellow,
        "name: floor, role: forbidden, shape: box, base_T_shape: {xyz: [0, 0.5, 0.5]}, size: [1, 0.1, 1]"};
    scene.tool = "spheres: [[0.01, 0, 0, 0.01], [0.02, 0, -0.01, 0.008], [0, 0.015, -0.03, 0.012]]";
    return scene;
}

std::vector<Image> images(size_t count) {
    std::vector<Image> all;
    for (size_t i = 0; i < count; ++i) {
        all.push_back(bumpImage().paint({20, 40, 20 + static_cast<uint32_t>(i), 44}, kRed)); // each differs
    }
    return all;
}

} // namespace

TEST_CASE("A replay writes every file of the contract, and its rows, counts and means agree") {
    Stage stage;
    stage.recording(images(4));
    stage.scene(fullScene());
    stage.hand(kPush);
    const Replay replay = stage.replay({"--save-fixtures"});
    CHECK(replay.ticks.size() == 500); // t = 0 to 0.499 s: the hand path is longer than the frames
    CHECK(replay.frames.size() == 4);
    CHECK(replay.haptic().at("max_force_N").get<double>() > 1.0);
    CHECK(replay.haptic().at("max_torque_Nm").get<double>() > 1e-4);

    const nlohmann::json& fixtures = replay.summary.at("fixtures");
    REQUIRE(fixtures.size() == 3);
    CHECK(fixtures[0].at("class") == "red");
    CHECK(fixtures[1].at("role") == "guidance");
    CHECK(fixtures[2].at("class") == "floor");
    // 400 red pixels plus i * 4 in frame i; 140 yellow pixels.
    CHECK(fixtures[0].at("points_mean").get<double>() == doctest::Approx(400 + 4 * 1.5));
    CHECK(fixtures[1].at("points_mean").get<double>() == doctest::Approx(140));
    for (const FrameRow& row : replay.frames) {
        CHECK(row.valid == kWidth * kHeight);
        CHECK(row.forbidden == 400 + 4 * row.index);
        CHECK(row.guidance == 140);
        CHECK(row.spheres > 200);
        CHECK(row.times.at("upload_ms") > 0.0);
        CHECK(row.times.at("publish_ms") > 0.0); // so checkContract requires a time for each pass
        CHECK(row.times.count("classify_ms") == 1);
    }
}

TEST_CASE("The guidance row of the summary is the mean of the class's points, and its target stands off "
          "along the normal") {
    Stage stage;
    stage.recording(images(2));
    SceneText scene = fullScene();
    scene.filter = "radius: 0, edge: 0";
    scene.fixtures[1] += ", standoff: 0.05";
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const Replay replay = stage.replay();
    const nlohmann::json& row = replay.summary.at("guidance").at(0);
    CHECK(row.at("class") == "yellow");
    CHECK(row.at("count") == 140);
    // Pixels 4..13 x 16..29 of a wall 600 mm away.
    CHECK(row.at("position_m")[0].get<double>() == doctest::Approx((8.5 - kCx) / kFocal * 0.6).epsilon(1e-5));
    CHECK(row.at("position_m")[1].get<double>() ==
          doctest::Approx((22.5 - kCy) / kFocal * 0.6).epsilon(1e-5));
    CHECK(row.at("position_m")[2].get<double>() == doctest::Approx(0.6).epsilon(1e-5));
    CHECK(row.at("normal")[2].get<double>() == doctest::Approx(-1.0).epsilon(1e-5));
    CHECK(row.at("target_m")[2].get<double>() == doctest::Approx(0.55).epsilon(1e-4));
}

TEST_CASE("A guidance class that is never seen has null for its pose, and a scene without forbidden points "
          "has no query") {
    Stage stage;
    stage.recording(images(2));
    SceneText scene;
    scene.fixtures = {"name: blue, role: guidance, hue: [200, 250], saturation: [0.4, 1]"};
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.1, {0.0, 0.0, 0.7}}});
    Terms terms;
    terms.empty = "blue";
    const Replay replay = stage.replay({}, terms);
    const nlohmann::json& row = replay.summary.at("guidance").at(0);
    for (const char* key : {"position_m", "normal", "target_m", "target_qwxyz"}) {
        CHECK(row.at(key).is_null());
    }
    CHECK(replay.summary.at("contact").at("where") == "none");
    CHECK(replay.haptic().at("max_force_N") == 0.0); // through the wall, which is not forbidden
    for (const FrameRow& frame : replay.frames) {
        CHECK(frame.spheres == 0);
        CHECK(frame.guidance == 0);
        CHECK(frame.times.count("spheres_ms") == 0);
    }
}

TEST_CASE("Equal runs give equal files and digests with the query on the CPU and on the GPU; another scene "
          "gives others") {
    Stage stage;
    stage.recording(images(4));
    SceneText scene = fullScene();
    stage.scene(scene);
    stage.hand(kPush);
    const Replay first = stage.replay({"--query", "cpu"}, {}, "a");
    const Replay again = stage.replay({"--query", "cpu"}, {}, "b");
    const Replay onGpu = stage.replay({"--query", "gpu"}, {}, "c");
    CHECK(first.summary.at("contact").at("where") == "cpu");
    CHECK(onGpu.summary.at("contact").at("where") == "gpu");
    CHECK(first.summary.at("digest") == again.summary.at("digest"));
    CHECK(first.summary.at("digest") == onGpu.summary.at("digest"));
    CHECK(stage.read("a/haptics.csv") == stage.read("b/haptics.csv"));
    CHECK(stage.read("a/haptics.csv") == stage.read("c/haptics.csv"));

    scene.fixtures[0] = "name: red, role: forbidden, hue: [345, 20], saturation: [0.4, 1], radius: 0.0401";
    stage.scene(scene);
    const Replay other = stage.replay({}, {}, "d");
    CHECK(first.summary.at("digest") != other.summary.at("digest"));
}

TEST_CASE("clearance_m sees regions beyond the reach and agrees with min_gap_m within it") {
    Stage stage;
    stage.recording(images(4));
    stage.scene(fullScene());
    stage.hand({{0.0, {0.0, 0.0, 0.38}}, {0.2, {0.0, 0.0, 0.50}}, {0.6, {0.0, 0.0, 0.50}}});
    const Replay replay = stage.replay();
    double farthest = 0.0;
    size_t near = 0;
    for (size_t i = 0; i < replay.ticks.size(); ++i) {
        const Tick& tick = replay.ticks[i];
        REQUIRE(std::isfinite(tick.clearance));
        farthest = std::max(farthest, tick.clearance - tick.minGap);
        if (tick.t > 0.4 && tick.contacts > 0) { // pressed and at rest
            CHECK(std::abs(tick.clearance - tick.minGap) < 1e-3);
            ++near;
        }
    }
    CHECK(farthest > 0.02);
    CHECK(near > 100);
}

TEST_CASE("A second run into the same folder replaces the files of the first, including its saved sets") {
    Stage stage;
    stage.recording(images(4));
    stage.hand(kPush);
    const Replay first = stage.replay({"--save-fixtures"});
    CHECK(std::filesystem::exists(first.ply(3)));
    stage.write("out/notes.txt", "mine");
    std::filesystem::remove_all(stage / "rec");
    stage.recording(images(2));
    const Replay second = stage.replay({"--save-fixtures"});
    CHECK(second.frames.size() == 2);
    CHECK(std::filesystem::exists(second.ply(1)));
    CHECK(!std::filesystem::exists(second.ply(3)));
    CHECK(stage.read("out/notes.txt") == "mine"); // prepareReplayFolder deletes only files of fathom
}

TEST_CASE("Relative paths in a scene start from the scene file, those on the command line from the working "
          "directory") {
    Stage stage;
    stage.recording(images(1));
    SceneText scene;
    scene.camera = "source: {recorded: rec}, near: 0.1, far: 3.0";
    scene.hand = "path: path.csv";
    stage.write("deep/scene.yaml", "");
    std::filesystem::rename(stage / "rec", stage / "deep/rec");
    stage.write("deep/path.csv", handCsv(kPush));
    stage.write("deep/scene.yaml", scene.text());
    RunSetting setting;
    setting.folder = stage.path();
    const ProgramRun run = runFathom({"replay", "deep/scene.yaml", "--out", "here/and/there"}, setting);
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    checkContract(readReplay(stage / "here/and/there", run), {});
}

TEST_CASE("The built-in hand path pushes into every forbidden region and visits every target") {
    Stage stage;
    stage.recording(images(2));
    SceneText scene = fullScene();
    scene.fixtures.pop_back();
    stage.scene(scene);
    const Replay replay = stage.replay();
    CHECK(replay.ticks.size() >= 4000);                           // at least 2 s per fixture
    CHECK(replay.haptic().at("max_force_N").get<double>() > 8.0); // 20 mm at 480 N/m
    double mostGuidance = 0.0;
    for (const Tick& tick : replay.ticks) {
        mostGuidance = std::max(mostGuidance, tick.guidance);
    }
    CHECK(mostGuidance == doctest::Approx(1.0));
}
