// SPDX-License-Identifier: Apache-2.0
// Runs of a random hand in a world with an audit of every pose; the guarantee and geometry cases use them.
#pragma once

#include "apps/stability/lockstep_rig.h"
#include "apps/stability/stability_case.h"
#include "apps/stability/worlds.h"

namespace fathom::stability {

struct HandRunFigures {
    double penetration = 0.0; // [m] deepest over all runs, beyond the allowance
    uint64_t runs = 0;
    RigFigures rig; // sums and maxima over all runs

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

// Does one run and adds it to `figures`.
void runHand(const World& world, const HandRun& handRun, HandRunFigures& figures);

// Outcome "deepest penetration <= limit". Also requires contacts, a travelled path and finite numbers, so
// that runs in free space cannot pass.
Outcome penetrationOutcome(const HandRunFigures& figures, double limit, const std::string& what);

} // namespace fathom::stability
