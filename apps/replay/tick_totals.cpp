// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/tick_totals.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

void lower(std::optional<double>& minimum, double value) {
    if (std::isfinite(value)) {
        minimum = minimum ? std::min(*minimum, value) : value;
    }
}

} // namespace

void TickTotals::add(const TickRow& row) {
    const StepRecord& tick = row.record;
    ++ticks;
    late += row.late;
    stalled += tick.stalled;
    trapped += tick.state == StepState::Trapped;
    escape += tick.state == StepState::Escape;
    waiting += tick.state == StepState::Waiting;
    vanished = tick.vanished;
    indexShift = glm::length(tick.indexShift);
    infeasible += tick.infeasible != 0;
    notFinite += !tick.finite;
    solves += tick.solves;
    if (isFinite(tick.wrench.force)) {
        maxForce = std::max(maxForce, glm::length(tick.wrench.force));
        maxForceStep = std::max(maxForceStep, glm::length(tick.wrench.force - lastForce_));
        lastForce_ = tick.wrench.force;
    }
    if (isFinite(tick.wrench.torque)) {
        maxTorque = std::max(maxTorque, glm::length(tick.wrench.torque));
    }
    lower(minMarginPassive, tick.marginPassive);
    lower(minMarginUncoupled, tick.marginUncoupled);
    stepMicros.push_back(static_cast<float>(row.micros));
}

} // namespace fathom
