// SPDX-License-Identifier: Apache-2.0
// A scripted path of the hand: timed waypoints, interpolated.
#pragma once

#include "engine/types/haptic_device.h"
#include "engine/types/pose.h"

#include <cstdint>
#include <vector>

namespace fathom {

// Intended pose and buttons of the hand at one time.
struct HandWaypoint {
    double t = 0.0;       // [s] since the run's start
    Pose deviceThandle;   // raw, device frame
    uint32_t buttons = 0; // bits of haptic_device.h, by level
};

// Immutable after construction; any number of threads may sample it.
class HandPath {
public:
    // Throws Error when there is no waypoint, a number is not finite, a quaternion has no length or time goes
    // back. Two waypoints at the same time make a jump. Quaternions are normalised.
    explicit HandPath(std::vector<HandWaypoint> waypoints);

    // Interpolates linearly and by the shortest arc; buttons of the last waypoint at or before t. Clamps to
    // the first and last waypoint.
    HandSample at(double t) const noexcept;

    double duration() const { return waypoints_.back().t; } // [s] time of the last waypoint
    const std::vector<HandWaypoint>& waypoints() const { return waypoints_; }

private:
    std::vector<HandWaypoint> waypoints_; // never empty, times ascending
};

} // namespace fathom
