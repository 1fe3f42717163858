// SPDX-License-Identifier: Apache-2.0
// New data came over the tool: how many turns it takes to be out again, and what happens on the way.
#pragma once

#include "apps/stability/lockstep_rig.h"

#include <functional>

namespace fathom::stability {

struct EscapeFigures {
    double depth = 0.0; // [m] deepest leaf when the data came
    int ticks = 0;      // until nothing overlaps; the limit when it never ends
    bool out = false;
    double growth = 0.0;  // [m] largest growth of the deepest depth from one turn to the next
    uint64_t trapped = 0; // turns
};

// Turns with the hand at `hand` until no leaf overlaps the set shown and the pose is `right` (if given), or
// `limit` turns.
EscapeFigures escape(LockstepRig& rig, const Pose& hand, int limit,
                     const std::function<bool(const Pose&)>& right = {});

} // namespace fathom::stability
