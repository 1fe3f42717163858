// SPDX-License-Identifier: Apache-2.0
// What a user should know about an arm in its scene: links that placed shapes do not hold, and fingers that
// are slower than the grasp.
#pragma once

#include "engine/cycle/arm_setup.h"

#include <string>
#include <vector>

namespace fathom {

// One line per keep_in shape that does not hold every link, and per forbidden shape with a link inside that
// no joint moves. At the start posture.
std::vector<std::string> shapeNotes(const Scene& scene, const ArmSetup& setup);

// The least time from open to closed that the speeds of the fingers allow.
struct GraspTime {
    double seconds = 0.0;
    std::string finger, speed; // of the slowest one; speed with its unit
};
GraspTime graspTimeOf(const ArmModel& model);

} // namespace fathom
