// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/wrench_figures.h"

#include <glm/geometric.hpp>

namespace fathom::operate {

bool atForceLimit(const StepRecord& record, const HapticOptions& limits) {
    return glm::length(record.wrench.force) > kAtLimit * limits.forceLimit;
}

bool atTorqueLimit(const StepRecord& record, const HapticOptions& limits) {
    return glm::length(record.wrench.torque) > kAtLimit * limits.torqueLimit;
}

std::array<WrenchFigures, 2> figuresOf(const std::deque<TraceSample>& trace, const Peaks& peaks,
                                       const FrameRipple& ripple, const HapticOptions& limits) {
    std::array<WrenchFigures, 2> all;
    const TraceSample last = trace.empty() ? TraceSample() : trace.back();
    all[0] = {.name = "Force", .unit = "N", .part = &TraceWrench::force, .colour = colour::kForce};
    all[1] = {.name = "Torque", .unit = "N m", .part = &TraceWrench::torque, .colour = colour::kTorque};
    all[0].limit = limits.forceLimit;
    all[0].peak = peaks.force;
    all[0].ripple = ripple.force();
    all[1].limit = limits.torqueLimit;
    all[1].peak = peaks.torque;
    all[1].ripple = ripple.torque();
    for (WrenchFigures& f : all) {
        f.delivered = double{glm::length(last.delivered().*f.part)};
        f.whole = double{glm::length(last.whole.*f.part)};
        f.residual = double{glm::length(last.residual.*f.part)};
    }
    return all;
}

} // namespace fathom::operate
