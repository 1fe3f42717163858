// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tune_source.h"

#include "apps/binding/open_source.h"
#include "devices/simulated/analytic_scene.h"
#include "engine/types/decimation.h"
#include "engine/types/error.h"

#include <algorithm>

namespace fathom::tune {

namespace {

constexpr size_t kMaxRead = 120;              // [frames] of a recording or a live camera
constexpr size_t kMaxBytes = size_t{1} << 29; // of all of them
constexpr size_t kOwnFrames = 8;              // of a recording, kept beside its twin
constexpr const char* kTwinScene = "torus";
constexpr double kTwinRange = 0.7;   // [m] to the twin's object
constexpr double kTwinUnit = 0.0001; // [m] of the twin's depth before rounding
constexpr double kOutlier = 6.0;     // [sigma] of a pixel that flies between two surfaces

bool isExact(const Scene& scene, const std::optional<std::filesystem::path>& source) {
    return !source && scene.source.kind == CameraSource::Kind::Simulated && scene.source.value != "sonar" &&
           !scene.port && !scene.beam;
}

FrameSequence takeFrames(Camera& camera, size_t most, const Pose& still) {
    FrameSequence sequence{camera.description(), camera.info(), {}};
    profile::takeFrames(camera, static_cast<uint32_t>(most), sequence, still);
    return sequence;
}

SimulatedCamera simulated(const Scene& scene, bool noise) {
    SimulatedCameraOptions options;
    options.baseTscene = scene.baseTcamera;
    options.noise = noise;
    options.metresPerUnit = noise ? options.metresPerUnit : kTwinUnit;
    options.yuyv = noise && scene.source.yuyv;
    return SimulatedCamera(*analyticScene(scene.source.value), options);
}

TuneSource exactSource(const Scene& scene, size_t most) {
    TuneSource result;
    SimulatedCamera seen = simulated(scene, true), exact = simulated(scene, false);
    result.frames = takeFrames(seen, most, scene.baseTcamera);
    const FrameSequence truth = takeFrames(exact, 1, scene.baseTcamera);
    result.trueCamera = truth.camera;
    result.truth = truth.frames.front();
    result.scene = scene;
    result.camera = seen.description();
    result.judgedBy = "the exact surface of the simulated scene '" + scene.source.value + "'";
    return result;
}

std::string noiseText(const DepthNoise& noise) {
    return std::string(noise.measured ? "" : "assumed ") + "noise " + profile::digits(1e3 * noise.sigma) +
           " mm at " + profile::digits(noise.range) + " m";
}

TuneSource stillSource(const Scene& scene, FrameSequence read, const StillPart& part, size_t most) {
    TuneSource result;
    MeanImage mean = meanOf(read, part);
    result.camera = read.name;
    result.judgedBy = "the mean of " + std::to_string(part.count) + " frames in which the camera stands " +
                      "still (" + noiseText(mean.noise) +
                      "): it shows noise and the filter's error, and no bias of the camera";
    result.trueCamera = mean.camera;
    result.truth = std::move(mean.image);
    const auto first = read.frames.begin() + static_cast<std::ptrdiff_t>(part.first);
    const auto count = static_cast<std::ptrdiff_t>(std::min(part.count, most));
    result.frames = {read.name, read.camera, {first, first + count}};
    result.scene = scene;
    return result;
}

// Draws the noise of the simulated camera anew with another size, rounded to the other camera's units.
void setNoise(FrameSequence& frames, const SampleFrame& exact, const DepthNoise& noise, double unit) {
    const NormalTable normal;
    const double own = SimulatedCamera::kDepthSigmaShare;
    const auto step = std::max(1.0, std::round(unit / kTwinUnit));
    for (uint32_t k = 0; k < frames.frames.size(); ++k) {
        std::vector<uint16_t>& depth = frames.frames[k].depth;
        for (uint32_t i = 0; i < depth.size(); ++i) {
            const double z = kTwinUnit * exact.depth[i], seen = kTwinUnit * depth[i];
            if (seen > 0.0 && std::abs(seen - z) < kOutlier * own * depthSigma(z)) {
                const uint64_t bits = counterBits(1, k, i, NoisePurpose::Depth);
                const double far = z / kTwinRange; // sigma grows with the square of the range
                const double drawn = z + noise.sigma * far * far * normal(static_cast<uint32_t>(bits));
                depth[i] = static_cast<uint16_t>(
                    std::clamp(step * std::round(drawn / (step * kTwinUnit)), 0.0, 65535.0));
            }
        }
    }
}

// The scene with the twin's classes: regions of the smallest radius around what is red, and a target on what
// is yellow if the scene has one.
Scene twinScene(Scene scene) {
    double radius = HUGE_VAL;
    for (const FixtureClass& f : scene.fixtures) {
        if (f.isPoints() && f.role == Role::Forbidden) {
            radius = std::min(radius, f.radius);
        }
    }
    const bool guides = scene.hasGuidance();
    scene.fixtures = profile::redAndYellow();
    scene.fixtures.front().radius = radius;
    if (!guides) {
        scene.fixtures.pop_back();
    }
    const Scene usual;
    scene.nearZ = usual.nearZ, scene.farZ = usual.farZ;
    scene.baseTcamera = Pose{};
    scene.attenuation.reset();
    return scene;
}

OwnFrames ownFrames(const Scene& scene, const FrameSequence& read) {
    OwnFrames own{scene, {read.name, read.camera, {}}};
    const size_t count = std::min(kOwnFrames, read.frames.size());
    for (size_t i = 0; i < count; ++i) {
        own.frames.frames.push_back(
            read.frames[i * (read.frames.size() - 1) / std::max<size_t>(1, count - 1)]);
    }
    return own;
}

TuneSource twinSource(const Scene& scene, const FrameSequence& read, size_t still, size_t most) {
    const CameraInfo& camera = read.camera;
    const DepthNoise noise = noiseOverTime(read);
    if (camera.depth.fan || noise.range == 0.0) {
        throw BadInput(read.name, "frames", noise.range == 0.0 ? "no depth" : "a sonar that moves",
                       "at least " + std::to_string(kMinStill) +
                           " frames in which camera and scene stand still");
    }
    TuneSource result;
    SimulatedCameraOptions options;
    options.width = camera.depth.width, options.height = camera.depth.height;
    // Pixels and noise on the object are as far apart and as large as at the median range of the recording.
    options.focal = camera.depth.fx * std::clamp(kTwinRange / noise.range, 0.25, 4.0);
    options.metresPerUnit = kTwinUnit;
    options.motion = false;
    SimulatedCamera seen(*analyticScene(kTwinScene), options);
    options.noise = false;
    SimulatedCamera exact(*analyticScene(kTwinScene), options);
    result.frames = takeFrames(seen, most, {});
    const FrameSequence truth = takeFrames(exact, 1, {});
    setNoise(result.frames, truth.frames.front(), noise, camera.metresPerUnit);
    result.frames.camera.poseless = camera.poseless;
    result.trueCamera = truth.camera;
    result.truth = truth.frames.front();
    result.scene = twinScene(scene);
    result.twin = true;
    result.own = ownFrames(scene, read);
    result.camera = read.name;
    result.judgedBy = "an analytic twin, because camera and scene stand still in no more than " +
                      std::to_string(still) + " frames in a row (" + std::to_string(kMinStill) +
                      " are needed): the scene '" + kTwinScene +
                      "', as this camera sees things at its median range (" + noiseText(noise) + ")";
    return result;
}

} // namespace

TuneSource tuneSource(const Scene& scene, const std::optional<std::filesystem::path>& source, size_t most) {
    if (isExact(scene, source)) {
        return exactSource(scene, most);
    }
    Scene used = scene;
    used.decimation = 1; // all pixels are needed to try other image sizes
    const std::unique_ptr<Camera> camera = openCamera(used, source);
    used.decimation = scene.decimation;
    takeUncertainty(used, *camera);
    const CameraInfo& info = camera->info();
    const size_t bytes = 2 * size_t{info.depth.pixels()} + 4 * size_t{info.colour.pixels()};
    const FrameSequence read =
        takeFrames(*camera, std::clamp(kMaxBytes / bytes, most, std::max(most, kMaxRead)), scene.baseTcamera);
    if (read.frames.empty()) {
        throw BadInput(camera->description(), "frames", "none", "a source with frames");
    }
    const StillPart part = longestStill(read);
    return part.enough() ? stillSource(used, read, part, most) : twinSource(used, read, part.count, most);
}

SampleFrame decimatedImage(const CameraInfo& camera, const SampleFrame& image, uint32_t n) {
    const CameraInfo small = decimated(camera, n);
    SampleFrame result;
    result.baseTcamera = image.baseTcamera;
    result.depth.resize(small.depth.pixels());
    decimate<uint16_t>(image.depth, camera.depth, n, result.depth);
    if (!camera.registered || image.colour.empty()) {
        result.colour = image.colour;
        result.packed = image.packed;
    } else {
        result.colour.resize(small.colour.pixels());
        decimate<uint32_t>(image.colour, camera.colour, n, result.colour);
    }
    return result;
}

} // namespace fathom::tune
