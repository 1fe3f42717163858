// SPDX-License-Identifier: Apache-2.0
// Measures how a tool escapes after new data covers it: the number of ticks and the depths on the way.
#pragma once

#include "apps/stability/case_text.h"
#include "apps/stability/lockstep_rig.h"

#include <functional>

namespace fathom::stability {

struct EscapeFigures {
    double depth = 0.0; // [m] deepest leaf when the data arrived
    int ticks = 0;      // until nothing overlaps; the limit when that never happens
    bool out = false;
    double growth = 0.0;  // [m] largest growth of the deepest depth from one tick to the next
    uint64_t trapped = 0; // ticks
};

// Steps with the hand at `hand` until no leaf overlaps the shown set and `right` (if given) accepts the pose,
// for at most `limit` ticks.
EscapeFigures escape(LockstepRig& rig, const Pose& hand, int limit,
                     const std::function<bool(const Pose&)>& right = {});

// Over many escapes.
struct EscapeTotals {
    double worst = 0.0;  // ticks as a share of the allowed ones
    double growth = 0.0; // [m] of a depth, or penetration
    uint64_t stuck = 0, notFinite = 0;

    void add(const EscapeFigures& one, double allowedTicks, const LockstepRig& rig);
    // Requires an end of every escape, no growth beyond `limit` [m] and finite wrenches.
    void requireGood(Outcome& out, double limit) const;
};

} // namespace fathom::stability
