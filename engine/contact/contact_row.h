// SPDX-License-Identifier: Apache-2.0
// One linear condition on the tool's next motion, independent of the solver's unknowns.
#pragma once

#include "engine/types/pose.h"

#include <cstdint>

namespace fathom {

// normal . (a + alpha x arm) + spin . alpha >= offset for the tool's motion [a; alpha]: paper eq. 4 with
// offset = -gap. The kinematics express it in the solver's unknowns. Kind Joint (a limit of an arm's joint)
// uses only `key`, `offset` (of the position or speed limit, the tighter) and `gap` (position limit).
struct ContactRow {
    enum class Kind : uint8_t { Sphere, Shape, Equality, Behind, Joint };

    dvec3 normal{0.0};   // unit (zero in a row of pure rotation), base axes, pointing out of the region
    dvec3 arm{0.0};      // leaf centre - tool centre [m], base axes
    dvec3 spin{0.0};     // unit in a row of pure rotation, else zero
    double gap = 0.0;    // [m] at the pose for which the row was built
    double offset = 0.0; // [m] or [rad]
    uint32_t leaf = 0;
    uint32_t pair = 0; // Sphere: index into the set's pairs; Shape, Equality: index of the shape
    Kind kind = Kind::Sphere;
    uint64_t key = 0; // identifies the contact across solves
};

} // namespace fathom
