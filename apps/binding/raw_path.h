// SPDX-License-Identifier: Apache-2.0
// Converts between the raw path of a hand device and the commanded tool poses.
#pragma once

#include "devices/simulated/hand_path.h"
#include "engine/scene/scene.h"

#include <vector>

namespace fathom {

// The raw hand poses (device frame) for commanded base_T_tool poses: the inverse of hand.map
// before any clutch.
std::vector<HandWaypoint> toHand(std::vector<HandWaypoint> waypoints, const Scene::Hand& hand);

// base_T_tool at the start of a raw path, and of a live hand.
Pose startOf(const HandPath& path, const Scene& scene);

} // namespace fathom
