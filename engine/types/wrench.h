// SPDX-License-Identifier: Apache-2.0
// Force and torque on the hand.
#pragma once

#include "engine/types/pose.h"

namespace fathom {

// Base axes; torque about the proxy's centre.
struct Wrench {
    dvec3 force{0.0};  // [N]
    dvec3 torque{0.0}; // [N m]
};

} // namespace fathom
