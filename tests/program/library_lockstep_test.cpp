// SPDX-License-Identifier: Apache-2.0
// fathom::Lockstep of the shared library against `fathom replay`: the same frames and hand give identical
// results.
#include "devices/recorded/hand_csv.h"
#include "devices/simulated/analytic_scene.h"
#include "devices/simulated/hand_path.h"
#include "devices/simulated/simulated_camera.h"
#include "tests/rig/stage.h"
#include "tests/support/sanitized.h"

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <sstream>

// Not inline here: internal types have the same names as those of v0.
#define FATHOM_BUILDING_LIBRARY
#include <fathom/lockstep.h>

namespace {

constexpr int kFrames = 12;

std::vector<fathom::Image> images() {
    std::vector<fathom::Image> all;
    for (int i = 0; i < kFrames; ++i) {
        all.push_back(fathom::bumpImage());
        all.back().set({2, 2, 8, 8}, static_cast<uint16_t>(600 - i)); // all frames differ
    }
    return all;
}

fathom::v0::Pose pose(const fathom::dvec3& p, const fathom::dquat& q) {
    return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
}

fathom::v0::Nanoseconds nanoseconds(double t) {
    return std::llround(t * 1e9);
}

std::string nameOf(fathom::v0::State state) {
    constexpr const char* kNames[]{"off", "free", "contact", "escape", "trapped", "fading", "waiting"};
    return kNames[static_cast<int>(state)];
}

void requireEqual(const fathom::v0::Step& step, const fathom::Tick& tick) {
    CAPTURE(tick.t);
    REQUIRE(nameOf(step.state) == tick.state);
    REQUIRE(step.frame == tick.frame);
    REQUIRE(step.wrench.force[0] == tick.force.x);
    REQUIRE(step.wrench.force[1] == tick.force.y);
    REQUIRE(step.wrench.force[2] == tick.force.z);
    REQUIRE(step.wrench.torque[2] == tick.torque.z);
    REQUIRE(step.baseTtool.position[0] == tick.tool.position.x);
    REQUIRE(step.baseTtool.position[1] == tick.tool.position.y);
    REQUIRE(step.baseTtool.position[2] == tick.tool.position.z);
    REQUIRE(step.baseTtool.rotation.w == tick.tool.rotation.w);
    REQUIRE((step.minGap == tick.minGap || (std::isnan(step.minGap) && std::isnan(tick.minGap))));
}

constexpr uint32_t kArmFrames = 121; // 4 s

// The shipped scene, but only its first 4 s: the tool has pressed into the region.
void stageArmValve(const fathom::Stage& stage) {
    std::ifstream shipped("apps/scenes/arm_valve.yaml"), path("apps/scenes/arm_valve.csv"),
        urdf("apps/scenes/arm41.urdf");
    std::string scene{std::istreambuf_iterator<char>(shipped), {}}, rows, line;
    const std::string source = "{simulated: wetmate}";
    REQUIRE(scene.find(source) != std::string::npos);
    scene.replace(scene.find(source), source.size(),
                  "{simulated: wetmate, pictures: " + std::to_string(kArmFrames) + "}");
    stage.write("scene.yaml", scene);
    stage.write("arm41.urdf", {std::istreambuf_iterator<char>(urdf), {}});
    for (int i = 0; std::getline(path, line) && (i == 0 || std::stod(line) <= 4.0); ++i) {
        rows += line + "\n";
    }
    stage.write("arm_valve.csv", rows);
}

// Joints and grasp per row of arm.csv.
std::vector<std::vector<double>> armRows(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(in, line)) {
        std::istringstream text(line);
        std::vector<double>& row = rows.emplace_back();
        for (std::string cell; row.size() < 6 && std::getline(text, cell, ',');) {
            row.push_back(std::strtod(cell.c_str(), nullptr));
        }
    }
    return rows;
}

fathom::v0::CameraModel modelOf(const fathom::CameraInfo& info) {
    const fathom::Intrinsics& lens = info.depth;
    fathom::v0::CameraModel model;
    model.depth = {lens.width, lens.height, lens.fx, lens.fy, lens.cx, lens.cy, {}};
    model.metresPerUnit = info.metresPerUnit;
    model.colourFormat = fathom::v0::ColourFormat::Rgba;
    return model;
}

// Plays the same images and hand through the program and the library.
void requireReplayed(const std::string& more) {
    const fathom::Stage stage;
    stage.recording(images());
    fathom::SceneText text;
    text.camera += more;
    text.fixtures.push_back(fathom::SceneText::kGuideYellow);
    text.contact = "delay: 2";
    stage.scene(text);
    stage.hand({{0.0, {0.0, 0.0, 0.40}}, {0.15, {0.0, 0.0, 0.52}}, {0.4, {0.01, 0.0, 0.53}}});
    fathom::Terms terms;
    const fathom::Replay replay = stage.replay({}, terms);
    REQUIRE(replay.ticks.size() > 300);

    fathom::v0::CameraModel camera;
    camera.depth = {
        fathom::kWidth, fathom::kHeight, fathom::kFocal, fathom::kFocal, fathom::kCx, fathom::kCy, {}};
    camera.colourFormat = fathom::v0::ColourFormat::Rgb;
    const fathom::Tick& first = replay.ticks.front();
    const fathom::v0::HandStart start{pose(first.device.position, first.device.rotation)};
    fathom::v0::Lockstep lockstep(fathom::v0::Scene::fromFile(stage / "scene.yaml"), camera, start);

    const std::vector<fathom::Image> frames = images();
    int shown = 0;
    uint64_t contacts = 0;
    for (const fathom::Tick& tick : replay.ticks) {
        for (; shown < kFrames && shown / 30.0 <= tick.t + 1e-9; ++shown) {
            const fathom::Image& image = frames[static_cast<size_t>(shown)];
            lockstep.process({image.depth.data(), image.colour.data(), {}, nanoseconds(shown / 30.0)});
            if (shown + 1 == kFrames) {
                lockstep.endFrames();
            }
        }
        lockstep.queryContacts();
        const fathom::v0::Step step =
            lockstep.step({pose(tick.device.position, tick.device.rotation)}, nanoseconds(tick.t));
        contacts += step.state == fathom::v0::State::Contact ? 1 : 0;
        requireEqual(step, tick);
    }
    CHECK(contacts > 50);
}

} // namespace

TEST_CASE("The library in lockstep gives exactly the forces and poses of a replay") {
    requireReplayed("");
    requireReplayed(", decimation: 2");
}

TEST_CASE("The library in lockstep moves a scene's arm exactly as a replay does" *
          doctest::skip(fathom::kSanitized)) {
    const fathom::Stage stage;
    stageArmValve(stage);
    const fathom::ProgramRun run = fathom::runFathom({"replay", (stage / "scene.yaml").string(), "--device",
                                                      "llvmpipe", "--out", (stage / "out").string()});
    INFO(run.err);
    REQUIRE(run.exitCode == 0);
    const fathom::Replay replay = fathom::readReplay(stage / "out", run);
    const std::vector<std::vector<double>> arm = armRows(stage / "out/arm.csv");
    REQUIRE(replay.ticks.size() == arm.size());
    REQUIRE(replay.ticks.size() > 3900);

    fathom::SimulatedCameraOptions options;
    options.frames = kArmFrames;
    fathom::SimulatedCamera camera(*fathom::analyticScene("wetmate"), options);
    const fathom::HandPath path(fathom::readHandCsv(stage / "arm_valve.csv"));
    const auto handAt = [&](double t) {
        const fathom::HandSample sample = path.at(t);
        return fathom::v0::Hand{pose(sample.deviceThandle.position, sample.deviceThandle.rotation),
                                static_cast<fathom::v0::Button>(sample.buttons)};
    };
    fathom::v0::EngineOptions engine;
    engine.computeDevice = "llvmpipe";
    fathom::v0::Lockstep lockstep(fathom::v0::Scene::fromFile(stage / "scene.yaml"), modelOf(camera.info()),
                                  {handAt(0.0).deviceThandle}, engine);
    uint32_t shown = 0, contacts = 0;
    for (size_t i = 0; i < replay.ticks.size(); ++i) {
        const double t = replay.ticks[i].t;
        for (; shown < kArmFrames && shown / 30.0 <= t + 1e-9; ++shown) {
            const fathom::Frame frame = *camera.next();
            const fathom::Pose at = frame->baseTcamera.value_or(fathom::Pose{});
            lockstep.process({frame->depth.data(), frame->colour.data(), pose(at.position, at.rotation),
                              nanoseconds(shown / 30.0)});
        }
        if (shown == kArmFrames) {
            lockstep.endFrames();
        }
        lockstep.queryContacts();
        const fathom::v0::Step step = lockstep.step(handAt(t), nanoseconds(t));
        requireEqual(step, replay.ticks[i]);
        for (size_t k = 0; k < 4; ++k) {
            REQUIRE(step.arm.joints[k] == arm[i][k + 1]);
        }
        REQUIRE(step.arm.grasp == arm[i][5]);
        contacts += step.state == fathom::v0::State::Contact ? 1 : 0;
    }
    CHECK(contacts > 300);
}
