// SPDX-License-Identifier: Apache-2.0
#include "engine/front/core.h"

#include "engine/cycle/haptic_notes.h"
#include "engine/cycle/start_notes.h"
#include "engine/run/open_scene.h"
#include "engine/scene/dead_gates.h"
#include "engine/types/decimation.h"
#include "engine/types/log.h"
#include "engine/types/printed.h"

#include <cmath>

namespace fathom::front {

namespace {

// Regions grow by the camera's uncertainty as they do by the registration's.
fathom::Scene withSigma(fathom::Scene scene, const CameraInfo& camera) {
    scene.registrationSigma = std::hypot(scene.registrationSigma, camera.sigma);
    return scene;
}

ReaderOptions readerOf(const v0::EngineOptions& given) {
    ReaderOptions reader;
    reader.program = given.reader;
    return reader;
}

void checkStart(const char* field, const v0::Pose& pose) {
    if (isUsable(internal(pose))) {
        return;
    }
    const auto& [x, y, z] = pose.position;
    const auto& [w, i, j, k] = pose.rotation;
    throw v0::BadInput(printed("hand: start: %s: position (%.9g, %.9g, %.9g) m, rotation (%.9g, %.9g, %.9g, "
                               "%.9g) (allowed: a place within 1000 km, a quaternion of non-zero length)",
                               field, x, y, z, w, i, j, k));
}

} // namespace

CameraSetup::CameraSetup(const v0::CameraModel& given, const fathom::Scene& scene)
    : model(given)
    , delivered(internal(given, scene.farZ))
    , decimation(scene.decimation)
    , info(decimated(delivered, decimation)) {
    if (scene.beam) {
        info.beam = scene.beam;
    }
    if (scene.port) {
        correction.emplace(*scene.port, info, scene.nearZ, scene.farZ, "camera " + model.name);
    }
}

HapticSetup::HapticSetup(const fathom::Scene& from, const CameraInfo& camera, const v0::EngineOptions& given)
    : scene(withSigma(from, camera))
    , arm(openArm(scene, readerOf(given)))
    , tool(openTool(scene, arm.get(), readerOf(given)))
    , shapes(shapesOf(scene))
    , options(makeHapticOptions(scene, tool))
    , measuredArm(given.measuredArm) {}

std::unique_ptr<HapticCycle> HapticSetup::cycle(const v0::HandStart& start) const {
    checkStart("deviceThandle", start.deviceThandle);
    const Pose hand = internal(start.deviceThandle);
    const Pose begin = start.baseTtool ? internal(*start.baseTtool) : Pose{};
    if (start.baseTtool) {
        checkStart("baseTtool", *start.baseTtool);
    }
    auto cycle = std::make_unique<HapticCycle>(tool, shapes, options, hand,
                                               start.baseTtool ? &begin : nullptr, arm.get());
    if (!measuredArm) {
        warnOfStart(scene, tool, arm.get(), cycle->place());
    }
    return cycle;
}

ComputeState::ComputeState(const HapticSetup& setup, const CameraInfo& camera, const std::string& device)
    : haptic(setup)
    , instance(haptic.scene.hasPoints() ? std::make_unique<gpu::Instance>() : nullptr)
    , cycles({instance.get(), device, haptic.scene, camera, haptic.tool, haptic.arm.get()},
             [&](const DeviceFacts& facts) {
                 return makePlan(haptic.scene, camera, static_cast<uint32_t>(haptic.tool.leafCount()), facts);
             })
    , firstDepth_(haptic.scene, camera)
    , checked_(!haptic.scene.hasPoints()) {
    for (const auto& notes :
         {unusedKeys(haptic.scene), hueNotes(haptic.scene), deadGates(haptic.scene, camera)}) {
        for (const std::string& note : notes) {
            log::warn("{}", note);
        }
    }
    for (const std::string& line : forceWarnings(haptic.scene)) {
        log::warn("{}", line);
    }
    if (haptic.arm) {
        setArm(haptic.arm->startPosture());
    }
}

FrameReport ComputeState::process(fathom::Frame&& frame) {
    if (!checked_) {
        check(frame);
    }
    return cycles.frames().process(std::move(frame));
}

void ComputeState::check(const fathom::Frame& frame) {
    const double time = frame->captureTime;
    firstTime_ = firstTime_.value_or(time);
    firstDepth_.look(frame->depth);
    checked_ = firstDepth_.seen() || time - *firstTime_ >= 1.0;
    if (checked_ && !firstDepth_.seen()) {
        log::warn("camera: {}", firstDepth_.fault("metresPerUnit"));
    }
}

void ComputeState::setArm(const ArmPosture& posture) {
    posture_ = posture;
    if (cycles.plan().selfFilter) {
        cycles.frames().setArm(haptic.arm->inImage(posture));
    }
}

double ComputeState::clearances(std::span<const v0::Pose> baseTtool, v0::Clearances& out) {
    std::vector<fathom::Pose> poses;
    for (const v0::Pose& given : baseTtool) {
        fathom::Pose pose = internal(given);
        if (isFinite(pose)) {
            pose.rotation = glm::normalize(pose.rotation);
        }
        poses.push_back(pose);
    }
    DeviceCycles::GapBatch batch;
    cycles.smallestGaps(poses, batch);
    out.frame = batch.frame;
    out.poses.clear();
    for (const SmallestGap& gap : batch.gaps) {
        out.poses.push_back(external(gap, haptic.tool, batch.origin));
    }
    return batch.captureTime;
}

void ComputeState::renew() {
    cycles.renew();
    setArm(posture_);
}

} // namespace fathom::front
