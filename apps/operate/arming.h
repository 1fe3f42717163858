// SPDX-License-Identifier: Apache-2.0
// The checks before forces come on.
#pragma once

#include "apps/operate/run_view.h"
#include "engine/cycle/haptic_options.h"
#include "engine/scene/scene.h"

#include <string>

namespace fathom::operate {

// Valid during the call only.
struct ArmingInput {
    const RunView& run;
    const Scene& scene;
    const HapticOptions& haptics;
    bool gpuGone = false;
    bool handGone = false; // the haptic device is disconnected or silent
};

// Why forces must stay off, and what to do: "hand is 105 mm inside 'red valve': hold C to re-centre".
// Empty: all checks passed. Forces that came on with the hand deep in a region would push it at once.
std::string whyNotArmed(const ArmingInput& input);

// The newest regions are so old, or so far from the future, that not even a slow camera explains it.
bool cameraSilent(const StepRecord& record);

// [s] in which forces that come on rise from zero to the limit [N]: at least 1.5 s, and at most 20 N/s.
double softStart(double forceLimit);

} // namespace fathom::operate
