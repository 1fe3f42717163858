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

// Why forces must stay off, and what mends it: "hand is 105 mm inside 'red valve': move it back to the tool".
// Empty: nothing speaks against them. Forces that came on with the hand deep in a region would push it at
// once.
std::string whyNotArmed(const ArmingInput& input);

} // namespace fathom::operate
