// SPDX-License-Identifier: Apache-2.0
// The built-in hand path `approach`: visits every fixture of the first fixture set from the camera's side.
#pragma once

#include "devices/simulated/hand_path.h"
#include "engine/contact/host_fixtures.h"
#include "engine/contact/region_grid.h"
#include "engine/contact/tool.h"
#include "engine/scene/scene.h"

#include <vector>

namespace fathom {

// Commanded base_T_tool poses every 10 ms from t = 0; the caller converts them with the inverse of hand.map.
// Visits the classes of points in file order, without those that have no points in the first set, for at
// least 2 s each. Starts and ends at a pose on the camera's side, clear of every region. Moves have minimum
// jerk and at most 0.25 m/s. Outside the pushes the path touches no region. `grid` must be built over
// firstSet.spheres.
// - forbidden: approaches along the camera's ray the region's point nearest to its centroid, to 20 mm beyond
//   the first contact of a leaf, and there rotates by up to 4 degrees, so that long tools feel torque.
// - guidance: stops 60 mm before the target, or just before a region in the way, with button 1 down for the
//   last 1.5 s.
std::vector<HandWaypoint> approachPath(const Scene& scene, const Tool& tool, const HostFixtures& firstSet,
                                       const RegionGrid& grid);

// Smallest gap [m] between the tool's leaves at a pose and the regions, at most `cap`. fixture >= 0: only
// spheres of that index into Scene::fixtures.
double leastGap(const Tool& tool, const HostFixtures& set, const RegionGrid& grid, const Pose& baseTtool,
                double cap, int fixture = -1);

} // namespace fathom
