// SPDX-License-Identifier: Apache-2.0
// The parts of Engine and Lockstep: camera, scene with tool and arm, and the device with its cycles.
#pragma once

#include "engine/contact/shapes.h"
#include "engine/cycle/device_cycles.h"
#include "engine/cycle/haptic_cycle.h"
#include "engine/front/public.h"
#include "engine/scene/first_depth.h"
#include "engine/types/flat_port.h"

#include <memory>
#include <optional>
#include <unistd.h>

namespace fathom::v0 {

struct Scene::Data {
    fathom::Scene scene;
};

} // namespace fathom::v0

namespace fathom::front {

// A camera in the scene. Immutable.
struct CameraSetup {
    CameraSetup(const v0::CameraModel& given, const fathom::Scene& scene);

    v0::CameraModel model;
    CameraInfo delivered;                     // images as they are submitted
    uint32_t decimation = 1;                  // the scene's
    CameraInfo info;                          // after decimation, with the scene's beam and flat port
    std::optional<PortCorrection> correction; // of depth, if the scene has a flat port
};

// Data for the haptic thread. Immutable after construction.
struct HapticSetup {
    HapticSetup(const fathom::Scene& from, const CameraInfo& camera, const v0::EngineOptions& given);
    std::unique_ptr<HapticCycle> cycle(const v0::HandStart& start) const;

    fathom::Scene scene;           // its uncertainty includes the camera's
    std::unique_ptr<ArmSetup> arm; // null without one
    Tool tool;
    std::vector<Shape> shapes;
    HapticOptions options;
    bool measuredArm = false; // starts where the real arm stands, not at the scene's posture
};

// Data for the frame and contact threads. `haptic` must outlive it.
struct ComputeState {
    ComputeState(const HapticSetup& haptic, const CameraInfo& camera, const std::string& device);

    // Frame thread, before a frame: where the arm is in its image. No effect without a self-filter.
    void setArm(const ArmPosture& posture);
    // Frame thread. Makes the newest fixture set. Warns after the first second if no depth was in range.
    FrameReport process(fathom::Frame&& frame);
    // Any thread but the haptic one. The stamp of `out` stays as it is. Returns the capture time [s] of its
    // frame.
    double clearances(std::span<const v0::Pose> baseTtool, v0::Clearances& out);
    void renew(); // frame thread, after a loss of the device

    const HapticSetup& haptic;
    std::unique_ptr<gpu::Instance> instance; // null: the scene has no passes
    DeviceCycles cycles;

private:
    void check(const fathom::Frame& frame);

    ArmPosture posture_;
    FirstDepth firstDepth_;
    std::optional<double> firstTime_; // [s] capture time of the first frame
    bool checked_ = false;
};

// Call in destructors; processId: that of the constructor. A forked child has none of the threads that `impl`
// and the driver of its device would wait for, so `impl` is never destroyed there.
template <class Impl>
void leakInForkedChild(pid_t processId, std::unique_ptr<Impl>& impl) noexcept {
    if (processId != ::getpid()) {
        static_cast<void>(impl.release());
    }
}

} // namespace fathom::front
