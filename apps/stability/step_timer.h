// SPDX-License-Identifier: Apache-2.0
// The haptic cycle alone with a tool of nine balls in a cross. Takes raw poses, returns step records.
#pragma once

#include "apps/stability/loop_rig.h"
#include "apps/stability/stability_case.h"
#include "apps/stability/worlds.h"

#include <vector>

namespace fathom::stability {

// device: preset that gives the actuated axes. limited: apply force, torque and slew limits. K_t = 1000 N/m,
// K_r = 2 N m/rad.
class StepTimer {
public:
    StepTimer(const char* device, bool limited, std::span<const Shape> shapes, const Pose& start)
        : tool_(toolOf(crossLeaves(0.008)))
        , options_(optionsFor(device, limited))
        , cycle_(tool_, shapes, options_, start) {}

    const StepRecord& step(const Pose& raw) {
        StepInput input = stepInput({raw, guidance.empty() ? 0 : kGuidanceButton}, time_);
        input.guidance = guidance;
        time_ += options_.period;
        return record_ = cycle_.step(input);
    }
    const HapticOptions& options() const { return options_; }
    std::vector<GuidancePose> guidance;

private:
    HapticOptions optionsFor(const char* device, bool limited) const {
        LoopSpec spec;
        spec.limited = limited;
        spec.controller = limited;
        spec.stiffness = 1000.0;
        spec.rotationalStiffness = 2.0;
        HapticOptions options = loopOptions(spec, tool_);
        options.device.actuated = devicePreset(device).actuated;
        return options;
    }
    Tool tool_;
    HapticOptions options_;
    HapticCycle cycle_;
    StepRecord record_;
    double time_ = 0.0;
};

// Part of the group rotation: orientations of any length, devices without all axes.
std::vector<Case> rotationDeviceCases();

} // namespace fathom::stability
