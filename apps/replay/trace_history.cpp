// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/trace_history.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

void widen(double& lo, double& hi, double otherLo, double otherHi) {
    if (otherHi < otherLo) {
        return;
    }
    lo = hi < lo ? otherLo : std::min(lo, otherLo);
    hi = std::max(hi, otherHi);
}

void merge(TraceBin& into, const TraceBin& next) {
    into.end = next.end;
    widen(into.forceMin, into.forceMax, next.forceMin, next.forceMax);
    widen(into.torqueMin, into.torqueMax, next.torqueMin, next.torqueMax);
    widen(into.restForceMin, into.restForceMax, next.restForceMin, next.restForceMax);
    widen(into.restTorqueMin, into.restTorqueMax, next.restTorqueMin, next.restTorqueMax);
    into.guidance = std::max(into.guidance, next.guidance);
    for (size_t i = 0; i < into.states.size(); ++i) {
        into.states[i] += next.states[i];
    }
    into.ticks += next.ticks;
    into.newFrames += next.newFrames;
}

void raise(TraceHistory::Peak& peak, double value, double t) {
    if (value > peak.value) {
        peak = {value, t};
    }
}

void take(const dvec3& v, double t, double& lo, double& hi, TraceHistory::Peak& peak) {
    if (isFinite(v)) {
        lo = hi = glm::length(v);
        raise(peak, hi, t);
    }
}

} // namespace

TraceHistory::TraceHistory(size_t capacity)
    : capacity_(std::max<size_t>(2, capacity + capacity % 2)) {
    bins_.reserve(capacity_);
}

void TraceHistory::add(const StepRecord& tick) {
    TraceBin now;
    now.begin = now.end = tick.t;
    const Wrench &delivered = tick.deviceWrench, &rest = tick.residual;
    take(delivered.force, tick.t, now.forceMin, now.forceMax, forcePeak_);
    take(delivered.torque, tick.t, now.torqueMin, now.torqueMax, torquePeak_);
    take(rest.force, tick.t, now.restForceMin, now.restForceMax, restForcePeak_);
    take(rest.torque, tick.t, now.restTorqueMin, now.restTorqueMax, restTorquePeak_);
    now.guidance = tick.guidance > 0.0 ? tick.guidance : 0.0; // NaN counts as none
    now.states[static_cast<uint8_t>(tick.state)] = 1;
    now.ticks = 1;
    now.newFrames = tick.frame != lastFrame_;
    newFrames_ += now.newFrames;
    lastFrame_ = tick.frame;
    ++ticks_;
    if (!bins_.empty() && bins_.back().ticks < stride_) {
        merge(bins_.back(), now);
        return;
    }
    if (bins_.size() == capacity_) {
        halve();
    }
    bins_.push_back(now);
}

void TraceHistory::halve() {
    for (size_t i = 0; i < bins_.size() / 2; ++i) {
        bins_[i] = bins_[2 * i];
        merge(bins_[i], bins_[2 * i + 1]);
    }
    bins_.resize(bins_.size() / 2);
    stride_ *= 2;
}

} // namespace fathom
