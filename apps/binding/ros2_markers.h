// SPDX-License-Identifier: Apache-2.0
// Regions and placed shapes as visualization_msgs/msg/MarkerArray.
#pragma once

#include "apps/binding/ros2_tick.h"

namespace fathom {

// All markers of before are deleted first. Spheres of one list have one size, so each class gets a list per
// step of a tenth in radius, rounded up. A plane is a square of 1 m, a line or an axis an arrow of 0.2 m
// along z.
std::vector<ros2::Marker> ros2Markers(const Ros2Regions& regions);

} // namespace fathom
