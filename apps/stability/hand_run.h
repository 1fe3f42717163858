// SPDX-License-Identifier: Apache-2.0
// A wild hand in a world for a while, every pose audited: what the guarantee and geometry cases are made of.
#pragma once

#include "apps/stability/lockstep_rig.h"
#include "apps/stability/stability_case.h"
#include "apps/stability/worlds.h"

namespace fathom::stability {

struct HandRunFigures {
    double penetration = 0.0; // [m] deepest beyond the allowance, all runs
    uint64_t runs = 0;
    RigFigures rig; // sums and largest figures of all runs

    void add(const LockstepRig& rig);
    void add(const HandRunFigures& other);
    std::string words() const; // for a note
};

struct HandRun {
    HandMotion motion;
    AnswerFaults faults;
    int ticks = 2000;
    uint64_t seed = 1;
    RigSetup setup;
};

// One run; adds to `figures`.
void runHand(const World& world, const HandRun& handRun, HandRunFigures& figures);

// Outcome "deepest penetration <= limit" that also demands that the runs were no air: contacts, a path,
// finite numbers.
Outcome penetrationOutcome(const HandRunFigures& figures, double limit, const std::string& what);

} // namespace fathom::stability
