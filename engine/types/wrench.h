// SPDX-License-Identifier: Apache-2.0
// Force and torque on the hand.
#pragma once

#include "engine/types/pose.h"

#include <glm/geometric.hpp>

namespace fathom {

// Base axes; torque about the proxy's centre.
struct Wrench {
    dvec3 force{0.0};  // [N]
    dvec3 torque{0.0}; // [N m]
};

// v shortened to length `limit`, same direction. limit >= 0.
inline dvec3 clampLength(const dvec3& v, double limit) noexcept {
    const double length = glm::length(v);
    return length > limit ? v * (limit / length) : v;
}

} // namespace fathom
