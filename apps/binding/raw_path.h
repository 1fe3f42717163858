// SPDX-License-Identifier: Apache-2.0
// Between the path of a hand, as its device gives it, and where that commands the tool.
#pragma once

#include "devices/simulated/hand_path.h"
#include "engine/scene/scene.h"

#include <vector>

namespace fathom {

// Commanded base_T_tool poses as the hand would make them, raw in the device frame: the inverse of hand.map
// before any clutch.
std::vector<HandWaypoint> toHand(std::vector<HandWaypoint> waypoints, const Scene::Hand& hand);

// base_T_tool where a raw path begins: where the tool of a live hand begins, too.
Pose startOf(const HandPath& path, const Scene& scene);

} // namespace fathom
