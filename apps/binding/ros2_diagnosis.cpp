// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_diagnosis.h"

#include "engine/types/number_text.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

using ros2::Diagnosis;
using Level = Diagnosis::Level;

Level levelOf(StepState state) {
    switch (state) {
    case StepState::Trapped:
        return Level::Error;
    case StepState::Escape:
    case StepState::Fading:
        return Level::Warning;
    case StepState::Off:
    case StepState::Free:
    case StepState::Contact:
    case StepState::Waiting:
        break;
    }
    return Level::Ok;
}

Diagnosis forcesOf(const StepRecord& r) {
    return {r.finite ? levelOf(r.state) : Level::Error,
            "fathom: forces",
            r.finite ? stateName(r.state) : "a number is not finite: no force",
            {{"force_n", significant(glm::length(r.wrench.force), 4)},
             {"torque_nm", significant(glm::length(r.wrench.torque), 4)},
             {"contacts", std::to_string(r.contactCount)},
             {"min_gap_m", significant(r.minGap, 4)},
             {"clearance_m", significant(r.clearance, 4)},
             {"lag_m", significant(r.lag, 4)},
             {"guidance", significant(r.guidance, 4)},
             {"margin_passive", significant(r.marginPassive, 4)},
             {"margin_uncoupled", significant(r.marginUncoupled, 4)}}};
}

Diagnosis cameraOf(const StepRecord& r, double setRate) {
    const bool known = std::isfinite(r.sceneAge), old = isOld(r.sceneAge);
    return {!known ? Level::Stale : (old ? Level::Warning : Level::Ok),
            "fathom: camera",
            !known ? "no set of regions yet"
                   : (!old               ? "ok"
                      : r.sceneAge < 0.0 ? "the newest frame is ahead of the clock"
                                         : "the newest frame is too old"),
            {{"sets_per_s", significant(setRate, 4)},
             {"scene_age_s", significant(r.sceneAge, 4)},
             {"frame", std::to_string(r.frame)}}};
}

Diagnosis armOf(const Ros2Tick& tick) {
    return {isFault(tick.armState) ? Level::Error : Level::Ok,
            "fathom: arm",
            armStateName(tick.armState),
            {{"at_limits", std::to_string(tick.record.arm.atLimits)},
             {"residual_m", significant(tick.record.arm.residual, 4)}}};
}

} // namespace

std::vector<Diagnosis> Ros2Diagnosis::of(const Ros2Tick& tick, uint64_t unsent) {
    const RunTotals& now = tick.totals;
    const double seconds =
        time_ != 0 && tick.time > time_ ? 1e-9 * static_cast<double>(tick.time - time_) : 0.0;
    const auto rate = [&](uint64_t count, uint64_t before) {
        return seconds > 0.0 ? static_cast<double>(count - before) / seconds : 0.0;
    };
    const uint64_t missed = now.missed - before_.missed;
    std::vector<Diagnosis> parts{forcesOf(tick.record), cameraOf(tick.record, rate(now.sets, before_.sets))};
    parts.push_back({missed > 0 ? Level::Warning : Level::Ok,
                     "fathom: haptic",
                     missed > 0 ? "periods without a step" : "ok",
                     {{"ticks_per_s", significant(rate(now.ticks, before_.ticks), 4)},
                      {"late", std::to_string(now.late - before_.late)},
                      {"missed", std::to_string(missed)},
                      {"worst_step_us", significant(now.worstMicros, 4)},
                      {"messages_not_sent", std::to_string(unsent)}}});
    if (tick.driven) {
        parts.push_back(armOf(tick));
    }
    before_ = now;
    time_ = tick.time;
    return parts;
}

} // namespace fathom
