// SPDX-License-Identifier: Apache-2.0
// What the frame thread sends to the haptic thread besides spheres, and the step input made from it.
#pragma once

#include "engine/cycle/step_record.h"
#include "engine/types/haptic_device.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <array>

namespace fathom {

// Frame thread to haptic thread. Times are in seconds on the run's clock.
struct SceneUpdate {
    int64_t frame = -1;
    uint64_t generation = 0;
    double captureTime = 0.0; // of the newest frame that confirms the set
    // No frame of a recording will follow: the last one stays valid and does not age.
    bool sourceEnded = false;
    bool live = false; // frames arrive by themselves: only the hand's path ends the run
    bool gone = false; // the camera or the compute device is lost, maybe for a while: the last frame ages
    uint32_t guidanceCount = 0;
    std::array<GuidancePose, shared::kMaxClasses> guidance;

    // Copies the data of a new fixture set; keeps the times.
    void show(const HostFixtures& set) noexcept {
        frame = set.frame;
        generation = set.generation;
        guidanceCount = static_cast<uint32_t>(std::min(set.guidance.size(), guidance.size()));
        std::copy_n(set.guidance.begin(), guidanceCount, guidance.begin());
    }
};

// The input of one step in a scene, without contact sets (ActiveContacts adds them). Points into `scene`.
inline StepInput stepInput(const SceneUpdate& scene, const HandSample& hand, double now) noexcept {
    StepInput input = stepInput(hand, now);
    input.frame = scene.frame;
    input.generation = scene.generation;
    input.captureTime = scene.captureTime;
    input.guidance = {scene.guidance.data(), scene.guidanceCount};
    input.sourceEnded = scene.sourceEnded;
    return input;
}

} // namespace fathom
