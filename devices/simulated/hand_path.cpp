// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/hand_path.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace fathom {

HandPath::HandPath(std::vector<HandWaypoint> waypoints)
    : waypoints_(std::move(waypoints)) {
    if (waypoints_.empty()) {
        throw Error("hand path: no waypoint");
    }
    for (size_t i = 0; i < waypoints_.size(); ++i) {
        HandWaypoint& w = waypoints_[i];
        if (!std::isfinite(w.t) || !isFinite(w.deviceThandle)) {
            throw Error("hand path: waypoint " + std::to_string(i) + " is not a finite time and pose");
        }
        if (i > 0 && w.t < waypoints_[i - 1].t) {
            throw Error("hand path: waypoint " + std::to_string(i) + " goes back in time");
        }
        w.deviceThandle.rotation = glm::normalize(w.deviceThandle.rotation);
    }
}

HandSample HandPath::at(double t) const noexcept {
    const auto after = std::ranges::upper_bound(waypoints_, t, {}, &HandWaypoint::t);
    if (after == waypoints_.begin()) {
        return {after->deviceThandle, after->buttons};
    }
    const HandWaypoint& before = *(after - 1);
    if (after == waypoints_.end()) {
        return {before.deviceThandle, before.buttons};
    }
    const double s = (t - before.t) / (after->t - before.t);
    return {interpolate(before.deviceThandle, after->deviceThandle, s), before.buttons};
}

} // namespace fathom
