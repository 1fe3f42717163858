// SPDX-License-Identifier: Apache-2.0
// Publishes a realtime run as topics of ROS 2.
#pragma once

#include "apps/binding/ros2_tick.h"
#include "apps/binding/run_observer.h"
#include "devices/ros2/ros2_output_request.h"

#include <memory>
#include <vector>

namespace fathom {

// Joins the graph, and publishes on a thread of its own until it is destroyed: the run never waits for DDS.
// joints: of the arm, in the order of its posture; empty = no arm. Throws BadInput: no Cyclone DDS, no such
// network, this program takes part through another one, or a trajectory without an arm.
std::unique_ptr<RunObserver> openRos2Output(const Ros2OutputRequest& request,
                                            const std::vector<Ros2Joint>& joints);

} // namespace fathom
