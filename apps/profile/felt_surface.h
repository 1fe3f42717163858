// SPDX-License-Identifier: Apache-2.0
// A still hand at the surface of a static analytic scene: where the tool rests, and how the force ripples
// while each frame brings a new set of regions.
#pragma once

#include "apps/profile/spread.h"
#include "engine/contact/fixtures.h"
#include "engine/contact/tool.h"
#include "engine/scene/scene.h"

#include <vector>

namespace fathom::profile {

struct FeltSurface {
    double error = 0.0;  // [m] RMS distance of the resting tool from the true resting place
    double bias = 0.0;   // [m] mean of the same; positive: in front of it
    double ripple = 0.0; // [N] RMS of the force about its mean, at 1000 N/m
    double band = 0.0;   // [N] its part in 10 to 35 Hz
    Cost query, step;    // [ms] of one contact query, of one haptic step
};

// Places the tool over several points of `truth` (regions of the exact surface), lets the hand press it 5 mm
// deep along the optical axis of the camera at the origin, and shows it `frames` in turn at rateHz for
// `seconds` per place. The sets need no generation. Throws Error when the tool touches nothing.
FeltSurface feelSurface(const Scene& scene, const Tool& tool, const Fixtures& truth,
                        const std::vector<Fixtures>& frames, double rateHz, double seconds);

} // namespace fathom::profile
