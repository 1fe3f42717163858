// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/open_source.h"

#include "apps/binding/open_recording.h"
#include "apps/binding/source_check.h"
#include "devices/decimated/decimated_camera.h"
#include "devices/openni2/open_openni2.h"
#include "devices/ros2/open_ros2.h"
#include "devices/simulated/analytic_scene.h"
#include "devices/simulated/simulated_camera.h"
#include "devices/simulated/simulated_sonar.h"
#include "devices/simulated/sonar_scene.h"
#include "devices/sonar/beam_camera.h"
#include "devices/v4l2/v4l2_camera.h"
#include "devices/water/water_camera.h"
#include "engine/scene/camera_limits.h"
#include "engine/types/error.h"
#include "engine/types/inside.h"
#include "engine/types/log.h"

#include <cmath>
#include <cstdio>
#include <set>

namespace fathom {

namespace {

void warnOutside(const std::filesystem::path& scene, const std::string& path) {
    log::warn("{}: '{}' is outside the scene file's folder", scene.string(), path);
}

std::unique_ptr<Camera> openSimulated(const Scene& scene) {
    if (scene.source.value == "sonar") {
        SimulatedSonarOptions sonar;
        sonar.baseTscene = scene.baseTcamera;
        sonar.frames = scene.source.images;
        return std::make_unique<SimulatedSonar>(sonarScene(), sonar);
    }
    const auto solids = analyticScene(scene.source.value);
    if (!solids) {
        throw BadInput(scene.file.string(), "camera.source.simulated", scene.source.value,
                       "tank, sphere, plane, torus, slot, gap, plate, corner, wetmate, sonar");
    }
    SimulatedCameraOptions options;
    options.baseTscene = scene.baseTcamera;
    options.frames = scene.source.images;
    options.yuyv = scene.source.yuyv;
    return std::make_unique<SimulatedCamera>(*solids, options);
}

std::unique_ptr<Camera> openLive(CameraRequest request, Delivery delivery) {
    request.everyFrame = delivery == Delivery::Every;
    return std::make_unique<V4l2Camera>(request);
}

// Scenes may leave the prefix out.
std::string withRos2(const std::string& text) {
    return isRos2Request(text) ? text : "ros2:" + text;
}

// A recording's file, or "ros2".
std::string nameOf(const std::string& source) {
    return isRos2Request(source) ? "ros2" : parseSource(source).file;
}

// Reports once which streams a recording is played from.
std::unique_ptr<Camera> openAndReport(const std::string& source, Delivery delivery, double farthest) {
    static std::set<std::string> reported; // one thread opens cameras
    std::unique_ptr<Camera> camera = openSource(source, delivery, farthest);
    if (const std::string streams = camera->streams(); !streams.empty() && reported.insert(source).second) {
        std::fprintf(stderr, "fathom: %s: %s\n", nameOf(source).c_str(), streams.c_str());
    }
    return camera;
}

std::unique_ptr<Camera> openDry(const Scene& scene, const std::optional<std::filesystem::path>& source,
                                Delivery delivery) {
    if (source) {
        return openAndReport(source->string(), delivery, scene.farZ);
    }
    switch (scene.source.kind) {
    case CameraSource::Kind::Simulated:
        return openSimulated(scene);
    case CameraSource::Kind::Recorded:
        return openAndReport(scene.source.value, delivery, scene.farZ);
    case CameraSource::Kind::Ros2:
        return openAndReport(withRos2(scene.source.value), delivery, scene.farZ);
    case CameraSource::Kind::V4l2:
        break;
    }
    CameraRequest request = parseCameraRequest(scene.source.value);
    if (!request.intrinsics.empty()) { // relative to the scene file, like all its paths
        const std::filesystem::path folder = scene.file.parent_path(), file = folder / request.intrinsics;
        if (!staysInside(request.intrinsics) || !liesInside(file, folder)) {
            warnOutside(scene.file, request.intrinsics.string());
        }
        request.intrinsics = file;
    }
    return openLive(request, delivery);
}

} // namespace

std::unique_ptr<Camera> openSource(const std::string& source, Delivery delivery, double farthest) {
    if (isCameraRequest(source)) {
        return openLive(parseCameraRequest(source), delivery);
    }
    if (isOpenNi2Request(source)) {
        return openOpenNi2(source);
    }
    if (isRos2Request(source)) {
        return openRos2(source, delivery == Delivery::Every, farthest);
    }
    SourceRequest request = parseSource(source);
    request.options.farthest = farthest;
    return openRecording(request);
}

std::unique_ptr<Camera> openCamera(const Scene& scene, const std::optional<std::filesystem::path>& source,
                                   Delivery delivery) {
    std::unique_ptr<Camera> camera = openDry(scene, source, delivery);
    checkCamera(camera->info(), camera->description());
    if (source || scene.source.kind != CameraSource::Kind::Simulated) {
        camera = std::make_unique<SourceCheck>(std::move(camera), scene);
    }
    if (scene.beam) {
        camera = std::make_unique<BeamCamera>(std::move(camera), *scene.beam);
    }
    // A recording contains all pixels, uncorrected, unless the window recorded what it used.
    if (scene.decimation > 1 && delivery != Delivery::Every && camera->info().decimation == 1) {
        camera = std::make_unique<DecimatedCamera>(std::move(camera), scene.decimation);
    }
    if (!scene.port || delivery == Delivery::Every || camera->info().inWater) {
        return camera;
    }
    return std::make_unique<WaterCamera>(std::move(camera), *scene.port, scene.nearZ, scene.farZ);
}

void takeUncertainty(Scene& scene, const Camera& camera) {
    scene.registrationSigma = std::hypot(scene.registrationSigma, camera.info().sigma);
}

} // namespace fathom
