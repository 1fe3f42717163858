// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/storm.h"

#include "apps/stability/case_text.h"

#include <algorithm>

namespace fathom::stability {

void StormFigures::add(const LockstepRig& one) {
    add(StormFigures{one.audit().maxPenetration(), 1, one.figures});
}

void StormFigures::add(const StormFigures& other) {
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

std::string StormFigures::words() const {
    return num(runs) + " runs, " + num(rig.ticks) + " turns, " + num(rig.contact) + " in contact, " +
           num(rig.stalled) + " stalled, " + num(rig.trapped) + " trapped, " + num(rig.refused) +
           " answers refused, path " + num(rig.path) + " m.";
}

void rage(const World& world, const Storm& storm, StormFigures& figures) {
    LockstepRig rig(toolOf(world.leaves), world.start, storm.setup);
    rig.show(world.fixtures);
    rig.faults = storm.faults;
    WildHand hand(world.start, world.focus, world.arena, storm.manner, storm.seed);
    for (int k = 0; k < storm.ticks; ++k) {
        rig.step(hand.next(rig.options().period));
    }
    figures.add(rig);
}

Outcome penetrationOutcome(const StormFigures& figures, double limit, const std::string& what) {
    Outcome out = outcomeOf(
        figures.penetration, limit, "m",
        "Deepest penetration of any leaf beyond its allowance, by an audit that sees the poses alone. " +
            what + figures.words());
    demand(out, figures.rig.contact > 0 && figures.rig.path > 0.0, "the tool never touched");
    demand(out, figures.rig.notFinite == 0, "a wrench that is not finite");
    return out;
}

} // namespace fathom::stability
