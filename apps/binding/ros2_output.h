// SPDX-License-Identifier: Apache-2.0
// Publishes a realtime run as topics of ROS 2.
#pragma once

#include "apps/binding/run_observer.h"
#include "devices/ros2/ros2_output_request.h"

#include <memory>
#include <string>
#include <vector>

namespace fathom {

// Joins the graph, and publishes on a thread of its own until it is destroyed: the run never waits for DDS.
// joints: names of the arm's, in the order of its posture; empty = no arm. Throws BadInput: no Cyclone DDS,
// no such network, or this program takes part through another one.
std::unique_ptr<RunObserver> openRos2Output(const Ros2OutputRequest& request,
                                            std::vector<std::string> joints);

} // namespace fathom
