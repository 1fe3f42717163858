// SPDX-License-Identifier: Apache-2.0
// A simulated camera renders the moving arm. Without the self-filter regions grow on the arm; with it none
// do.
#include "tests/rig/program_refusal.h"
#include "tests/rig/stage.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <future>

using namespace fathom;

namespace {

// Everything between the arm's reach and the panel is forbidden, so regions there are on the arm.
std::string sceneText(const std::string& selfFilter) {
    const std::string urdf = std::filesystem::absolute("apps/scenes/arm41.urdf").string();
    return "camera: { source: {simulated: wetmate, arm: true, pictures: 18}, near: 0.1, far: 3.0 }\n"
           "filter: { radius: 2, sigma: 0.01, edge: 0.03 }\nhold_s: 0\n"
           "fixtures:\n  - { name: near, role: forbidden, range: [0.05, 0.72], radius: 0.01 }\n"
           "arm:\n  urdf: " +
           urdf +
           "\n  tip: tip\n  base_T_arm: {xyz: [0.10, 0.30, 0.22], quat_xyzw: [0.5, -0.5, 0.5, 0.5]}\n"
           "  leaves: 64\n  direction: free\n" +
           selfFilter +
           "  joints:\n    - { name: shoulder, start: 1.5 }\n    - { name: elbow, start: -2.0 }\n"
           "hand: { path: hand.csv }\nhaptics: { rate_hz: 200 }\n";
}

struct Seen {
    double points = 0.0;      // points per frame
    int images = 0, with = 0; // frames with any region
    double moved = 0.0;       // [m] travel of the tip
};

Seen look(const std::string& selfFilter) {
    Stage stage;
    stage.write("scene.yaml", sceneText(selfFilter));
    stage.write("hand.csv",
                handCsv({{0.0, {0.0, 0.0, 0.4}}, {0.3, {-0.15, -0.1, 0.45}}, {0.6, {0.1, 0.0, 0.4}}}));
    const ProgramRun run =
        runFathom({"replay", (stage / "scene.yaml").string(), "--out", (stage / "out").string()});
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    Seen seen;
    for (const FrameRow& row : readFrames(stage / "out/frames.csv")) {
        seen.points += static_cast<double>(row.forbidden);
        seen.with += row.spheres > 0 ? 1 : 0;
        ++seen.images;
    }
    seen.points /= std::max(1, seen.images);
    const std::vector<Tick> ticks = readTicks(stage / "out/haptics.csv");
    for (const Tick& tick : ticks) {
        seen.moved = std::max(seen.moved, glm::distance(tick.tool.position, ticks.front().tool.position));
    }
    return seen;
}

} // namespace

TEST_CASE("An arm in the camera's view grows regions on itself, and with the self-filter it does not" *
          doctest::skip(kSanitized)) {
    auto other = std::async(std::launch::async, [] { return look(""); }); // each renders on one CPU
    const Seen filtered = look("  self_filter: 0.01\n"), plain = other.get();
    MESSAGE("points a picture: " << plain.points << " on the arm without the filter, " << filtered.points
                                 << " with it; it moved " << filtered.moved << " m");
    CHECK(plain.images == 18);
    CHECK(plain.with == 18);
    CHECK(plain.points > 10000.0);
    // The rest is not on the arm: flying pixels between its edge and the panel, and particles in the water.
    CHECK(filtered.points < 0.006 * plain.points);
    CHECK(filtered.moved > 0.1);
}

TEST_CASE("Only a simulated camera renders an arm, and only in a scene with an arm") {
    Stage stage;
    stage.scene({});
    const auto refused = [&](const std::string& camera, const std::vector<std::string>& parts) {
        stage.write("scene.yaml",
                    "camera: {source: {" + camera +
                        "}}\nfixtures: [{name: a, role: forbidden}]\ntool: {spheres: [[0, 0, 0, "
                        "0.01]]}\n");
        checkRefused(stage, parts);
    };
    refused("simulated: tank, arm: true", {"camera.source.arm", "true", "false without a section arm"});
    refused("simulated: sonar, arm: true", {"camera.source.arm", "draws none"});
    refused("v4l2: auto, arm: true", {"camera.source.arm", "only a simulated camera"});
    refused("simulated: tank, pictures: 0", {"camera.source.pictures", "0", "1 to 100000"});
    refused("v4l2: auto, pictures: 3", {"camera.source.pictures", "only a simulated camera"});
}
