// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/escape_run.h"

#include <algorithm>

namespace fathom::stability {

EscapeFigures escape(LockstepRig& rig, const Pose& hand, int limit,
                     const std::function<bool(const Pose&)>& right) {
    EscapeFigures figures;
    double depth = rig.depth();
    figures.depth = depth;
    const auto done = [&] { return depth <= 0.0 && (!right || right(rig.pose())); };
    for (int k = 1; k <= limit && !done(); ++k) {
        const StepRecord record = rig.step(hand);
        const double now = rig.depth();
        figures.growth = std::max(figures.growth, now - std::max(0.0, depth));
        figures.trapped += record.state == StepState::Trapped ? 1 : 0;
        depth = now;
        figures.ticks = k;
    }
    figures.out = done();
    return figures;
}

void EscapeTotals::add(const EscapeFigures& one, double allowedTicks, const LockstepRig& rig) {
    worst = std::max(worst, one.ticks / allowedTicks);
    growth = std::max({growth, one.growth, rig.audit().maxPenetration()});
    stuck += one.out ? 0 : 1;
    notFinite += rig.figures.notFinite;
}

void EscapeTotals::requireGood(Outcome& out, double limit) const {
    require(out, stuck == 0, num(stuck) + " never out");
    require(out, growth <= limit, "a depth grew by " + num(growth) + " m");
    require(out, notFinite == 0, "a wrench that is not finite");
}

} // namespace fathom::stability
