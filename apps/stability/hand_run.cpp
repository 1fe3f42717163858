// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/hand_run.h"

#include "apps/stability/case_text.h"

#include <algorithm>

namespace fathom::stability {

void HandRunFigures::add(const LockstepRig& one) {
    add(HandRunFigures{one.audit().maxPenetration(), 1, one.figures});
}

void HandRunFigures::add(const HandRunFigures& other) {
    const RigFigures& f = other.rig;
    penetration = std::max(penetration, other.penetration);
    runs += other.runs;
    rig.ticks += f.ticks;
    rig.contact += f.contact;
    rig.stalled += f.stalled;
    rig.trapped += f.trapped;
    rig.escape += f.escape;
    rig.refused += f.refused;
    rig.notFinite += f.notFinite;
    rig.path += f.path;
    rig.force = std::max(rig.force, f.force);
    rig.torque = std::max(rig.torque, f.torque);
    rig.forceStep = std::max(rig.forceStep, f.forceStep);
    rig.torqueStep = std::max(rig.torqueStep, f.torqueStep);
}

std::string HandRunFigures::words() const {
    return num(runs) + " runs, " + num(rig.ticks) + " ticks, " + num(rig.contact) + " in contact, " +
           num(rig.stalled) + " stalled, " + num(rig.trapped) + " trapped, " + num(rig.refused) +
           " answers refused, path " + num(rig.path) + " m.";
}

void runHand(const World& world, const HandRun& handRun, HandRunFigures& figures) {
    LockstepRig rig(toolOf(world.leaves), world.start, handRun.setup);
    rig.show(world.fixtures);
    rig.faults = handRun.faults;
    RandomHand hand(world.start, world.focus, world.arena, handRun.motion, handRun.seed);
    for (int k = 0; k < handRun.ticks; ++k) {
        rig.step(hand.next(rig.options().period));
    }
    figures.add(rig);
}

Outcome penetrationOutcome(const HandRunFigures& figures, double limit, const std::string& what) {
    Outcome out =
        outcomeOf(figures.penetration, limit, "m",
                  "Deepest penetration of any leaf beyond its allowance, by an audit of the poses only. " +
                      what + figures.words());
    require(out, figures.rig.contact > 0 && figures.rig.path > 0.0, "the tool never touched");
    require(out, figures.rig.notFinite == 0, "a wrench that is not finite");
    return out;
}

} // namespace fathom::stability
