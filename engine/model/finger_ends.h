// SPDX-License-Identifier: Apache-2.0
// Which end of a gripper joint is closed.
#pragma once

#include "engine/model/arm_mimic.h"

#include <map>
#include <string>
#include <vector>

namespace fathom {

// For fingers whose `open` and `closed` the options leave out: `closed` becomes the end where the leaves of
// the finger, and of those that move with it, are nearer to the other fingers, or to what carries it if there
// are none. Where that differs by less than a millimetre on average, the ends stay. One note per such finger,
// and per finger with one given end, whose other end is the limit farther from it. ties: of all joints.
std::vector<std::string> chooseFingerEnds(ArmModel& model, const ArmOptions& options,
                                          const std::map<std::string, JointTie>& ties);

} // namespace fathom
