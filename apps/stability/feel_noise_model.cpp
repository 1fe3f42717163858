// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/feel_noise_model.h"

#include "apps/stability/case_text.h"
#include "engine/reference/classify.h"
#include "engine/reference/estimate.h"
#include "engine/reference/rng.h"
#include "engine/reference/surface.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr int kAcross = 40, kDown = 32; // [pixels]
constexpr int kRest = 30, kMove = 14;   // [frames]
constexpr double kFramesPerSecond = 30.0;

Scene estimatedScene() {
    Scene scene;
    FixtureClass wall;
    wall.name = "wall";
    wall.radius = 0.2;
    scene.fixtures.push_back(wall);
    scene.filter.memory = 30;
    return scene;
}

CameraInfo smallCamera() {
    CameraInfo info;
    info.depth.width = kAcross;
    info.depth.height = kDown;
    info.depth.fx = info.depth.fy = 50.0;
    info.depth.cx = 0.5 * (kAcross - 1);
    info.depth.cy = 0.5 * (kDown - 1);
    info.colour = info.depth;
    info.metresPerUnit = 0.0001;
    info.hasColour = false;
    return info;
}

// [m] how far points are behind the true surface, of estimates and of plain points, in the frames that count.
struct BehindTruth {
    std::vector<double> estimated, plain;
};

double worstOfMost(std::vector<double> values) { // the 99.9th percentile
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double rmsOf(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values) {
        sum += v * v;
    }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

// Noise of `share` times the sigma that the program assumes; a wall that rests and then comes nearer.
BehindTruth watchWall(double share, double range, double speed) {
    const Scene scene = estimatedScene();
    const CameraInfo camera = smallCamera();
    reference::DepthEstimates estimates;
    Rng rng(11);
    BehindTruth behind;
    std::vector<uint16_t> depth(camera.depth.pixels());
    for (int frame = 0; frame < kRest + kMove; ++frame) {
        const double z = range - speed * std::max(0, frame - kRest + 1) / kFramesPerSecond;
        for (uint16_t& raw : depth) {
            const double seen = z + share * depthSigma(z) * rng.normal();
            raw = static_cast<uint16_t>(std::clamp(std::lround(seen / camera.metresPerUnit), 1l, 65535l));
        }
        const reference::FrameView view(scene, camera, Pose{}, depth, {});
        std::vector<uint32_t> masks = reference::classify(view, nullptr).masks;
        reference::PointImage points = reference::surface(view, masks).points;
        const std::vector<double> plain = points.z;
        estimates.step(view, std::vector<uint8_t>(depth.size(), 1),
                       frame > 0 ? std::optional(Pose{}) : std::nullopt, masks, points);
        for (size_t i = 0; i < plain.size(); ++i) {
            if (frame >= (speed > 0.0 ? kRest : kRest / 2) && plain[i] != 0.0 && points.z[i] != 0.0) {
                behind.estimated.push_back(points.z[i] - z);
                behind.plain.push_back(plain[i] - z);
            }
        }
    }
    return behind;
}

// A camera whose noise is not what the program assumes: no point of the memory may be farther behind the true
// surface than 1 mm or the plain points, and a still surface may not get worse than theirs.
Outcome wrongSigma(RunLength runLength, double share) {
    double worst = -1.0, still = 0.0;
    const std::vector<double> fast = {0.006, 0.02, 0.03, 0.05, 0.1, 0.4, 1.0};
    const std::vector<double> few = {0.02, 0.05, 0.4};
    for (const double range : {0.5, 0.8}) {
        const BehindTruth rest = watchWall(share, range, 0.0);
        still = std::max(still, rmsOf(rest.estimated) / rmsOf(rest.plain));
        for (const double speed : runLength == RunLength::Full ? fast : few) {
            const BehindTruth moved = watchWall(share, range, speed);
            const double allowed = std::max(0.001, 1.05 * worstOfMost(moved.plain));
            worst = std::max(worst, worstOfMost(moved.estimated) - allowed);
        }
    }
    Outcome out =
        outcomeOf(worst, 0.0, "m",
                  "A wall comes at up to 1 m/s before a camera whose noise is " + num(share) +
                      " times what the program assumes, with filter.memory: 99.9th percentile by "
                      "which points are behind the true surface, less 1 mm or that of plain points. "
                      "At rest the error is " +
                      num(still) + " of that of plain points.");
    require(out, still <= 1.05, "a still surface gets worse: " + num(still));
    return out;
}

} // namespace

void addFeelNoiseModel(std::vector<Case>& cases) {
    cases.push_back(
        {"feel-sigma-10-times-too-large", Group::Feel, [](RunLength e) { return wrongSigma(e, 0.1); }});
    cases.push_back(
        {"feel-sigma-10-times-too-small", Group::Feel, [](RunLength e) { return wrongSigma(e, 10.0); }});
}

} // namespace fathom::stability
