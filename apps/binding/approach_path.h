// SPDX-License-Identifier: Apache-2.0
// The built-in hand path `approach`: visits every fixture of the first fixture set from the camera's side.
#pragma once

#include "devices/simulated/hand_path.h"
#include "engine/contact/fixtures.h"
#include "engine/contact/region_grid.h"
#include "engine/contact/tool.h"
#include "engine/scene/scene.h"

#include <vector>

namespace fathom {

// Commanded base_T_tool poses (the caller maps them back through hand.map), t from 0, every 10 ms. Classes of
// points in file order; one without points in the first set is skipped. Starts and ends at a stance clear of
// every region, on the camera's side; takes at least 2 s per fixture; minimum-jerk moves of at most 0.25 m/s.
//   forbidden: along the camera's ray to the region's point nearest its centroid, 20 mm beyond the first pose
//   at which some tool leaf touches that region; there a rotation of up to 4 degrees, so that long tools feel
//   torque guidance:  to 60 mm before the target (or just before a region in the way); button 1 for the
//   last 1.5 s there
// Outside the push the path touches no region. `grid` must be built over firstSet.spheres.
std::vector<HandWaypoint> approachPath(const Scene& scene, const Tool& tool, const Fixtures& firstSet,
                                       const RegionGrid& grid);

// Smallest gap between the tool's leaves at a pose and the regions [m], at most `cap`. `fixture` >= 0: only
// spheres of that row of Scene::fixtures.
double leastGap(const Tool& tool, const Fixtures& set, const RegionGrid& grid, const Pose& baseTtool,
                double cap, int fixture = -1);

} // namespace fathom
