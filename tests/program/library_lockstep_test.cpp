// SPDX-License-Identifier: Apache-2.0
// fathom::Lockstep of the shared library against `fathom replay`: the same frames and hand give identical
// results.
#include "tests/rig/stage.h"

#include <cmath>
#include <doctest/doctest.h>

// Included after all internal headers, because its types have the same names, in the inline namespace v0.
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
    constexpr const char* kNames[]{"off", "free", "contact", "escape", "trapped", "fading"};
    return kNames[static_cast<int>(state)];
}

} // namespace

TEST_CASE("The library in lockstep gives exactly the forces and poses of a replay") {
    const fathom::Stage stage;
    stage.recording(images());
    fathom::SceneText text;
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
        lockstep.answer();
        const fathom::v0::Step step =
            lockstep.step({pose(tick.device.position, tick.device.rotation)}, nanoseconds(tick.t));
        contacts += step.state == fathom::v0::State::Contact ? 1 : 0;
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
    CHECK(contacts > 50);
}
