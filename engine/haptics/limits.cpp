// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/limits.h"

#include "engine/types/angle.h"

#include <cmath>

namespace fathom {

bool isFinite(const Wrench& wrench) noexcept {
    return isFinite(wrench.force) && isFinite(wrench.torque);
}

Wrench scaled(const Wrench& wrench, double factor) noexcept {
    return {wrench.force * factor, wrench.torque * factor};
}

dvec3 clampLength(const dvec3& v, double limit) noexcept {
    const double length = glm::length(v);
    return length > limit ? v * (limit / length) : v;
}

dvec3 projectedOn(const dvec3& v, const dvec3& axis) noexcept {
    const double square = glm::dot(axis, axis);
    return square > 0.0 ? axis * (glm::dot(v, axis) / square) : dvec3(0.0);
}

Wrench limitSize(const Wrench& wrench, double force, double torque) noexcept {
    return {clampLength(wrench.force, force), clampLength(wrench.torque, torque)};
}

Wrench limitSlew(const Wrench& wanted, const Wrench& previous, double forceStep, double torqueStep) noexcept {
    return {previous.force + clampLength(wanted.force - previous.force, forceStep),
            previous.torque + clampLength(wanted.torque - previous.torque, torqueStep)};
}

double lowPassGain(double hz, double period) noexcept {
    return hz > 0.0 ? -std::expm1(-kTurn * hz * period) : 1.0;
}

double lowPassDelayTicks(double gain) noexcept {
    return (1.0 - gain) / gain;
}

Wrench lowPass(const Wrench& input, const Wrench& previous, double gain) noexcept {
    if (gain >= 1.0) {
        return input; // off: not even rounding
    }
    return {previous.force + gain * (input.force - previous.force),
            previous.torque + gain * (input.torque - previous.torque)};
}

ProjectedWrench projectOnAxes(const Wrench& wrench, const dquat& baseRhandle,
                              const AxisMask& actuated) noexcept {
    const dquat handleRbase = glm::conjugate(baseRhandle);
    dvec3 force = handleRbase * wrench.force, torque = handleRbase * wrench.torque;
    bool all = true;
    for (int i = 0; i < 3; ++i) {
        force[i] = actuated[i] ? force[i] : 0.0;
        torque[i] = actuated[i + 3] ? torque[i] : 0.0;
        all = all && actuated[i] && actuated[i + 3];
    }
    if (all) {
        return {wrench, {}};
    }
    const Wrench delivered{baseRhandle * force, baseRhandle * torque};
    return {delivered, {wrench.force - delivered.force, wrench.torque - delivered.torque}};
}

} // namespace fathom
