// SPDX-License-Identifier: Apache-2.0
// Where a finger is open and closed by the scene, or by the usual rules for its joint.
#pragma once

#include "engine/model/arm_model.h"

#include <urdf_model/joint.h>
#include <utility>

namespace fathom {

// Open and closed [rad], [m]. An end that the scene does not give is the usual one, or the limit farther from
// the one that it gives. The joint has limits.
std::pair<double, double> graspEnds(const ArmOptions::Finger& wanted, const urdf::Joint& joint);

} // namespace fathom
