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

} // namespace fathom::stability
