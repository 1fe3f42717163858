// SPDX-License-Identifier: Apache-2.0
// State of the ports that outlives their engine: the haptic cycle, its inputs, and the channels between the
// threads.
#pragma once

#include "engine/front/core.h"
#include "engine/run/arm_link.h"
#include "engine/run/channels.h"
#include "engine/run/run_clock.h"
#include "engine/types/triple_buffer.h"

#include <atomic>

namespace fathom::front {

// Used by the engine's threads and the ports.
struct PortState {
    PortState(const fathom::Scene& scene, const CameraInfo& camera, const v0::EngineOptions& options)
        : haptic(scene, camera, options)
        , channels(kRows) {
        clock.start(-kPast);
        if (options.measuredArm && !haptic.arm) {
            throw v0::BadInput("options: measuredArm: true (allowed: false: the scene has no arm)");
        }
        channels.arm = options.measuredArm ? &arm : nullptr;
    }
    HapticSetup haptic;
    RunClock clock; // t = 0 is in the past, so that frames older than the engine keep their age
    Channels channels;
    ArmLink arm;                          // of a real arm, if channels.arm points to it
    TripleBuffer<v0::Regions> regions;    // frame thread -> display, once there is one
    TripleBuffer<v0::StepSnapshot> steps; // haptic thread -> display
    std::atomic<bool> ended{false};       // the engine is destroyed, or one of its threads failed
    std::atomic<bool> handOpen{false}, armOpen{false}, observerOpen{false};

    static constexpr uint64_t kRows = 16;  // capacity of queues that are never read
    static constexpr double kPast = 100.0; // [s]
};

} // namespace fathom::front
