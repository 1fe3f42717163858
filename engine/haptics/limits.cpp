// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/limits.h"

#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>

namespace fathom {

bool isFinite(const Wrench& wrench) noexcept {
    return isFinite(wrench.force) && isFinite(wrench.torque);
}

bool isZero(const Wrench& wrench) noexcept {
    return wrench.force == dvec3(0.0) && wrench.torque == dvec3(0.0);
}

Wrench scaled(const Wrench& wrench, double factor) noexcept {
    return {wrench.force * factor, wrench.torque * factor};
}

dvec3 projectedOn(const dvec3& v, const dvec3& axis) noexcept {
    const double square = glm::dot(axis, axis);
    return square > 0.0 ? axis * (glm::dot(v, axis) / square) : dvec3(0.0);
}

dvec3 wantedPart(const dvec3& v, const dvec3& wanted) noexcept {
    const double square = glm::dot(wanted, wanted);
    return square > 0.0 ? wanted * glm::clamp(glm::dot(v, wanted) / square, 0.0, 1.0) : dvec3(0.0);
}

Wrench limitSize(const Wrench& wrench, double force, double torque) noexcept {
    return {clampLength(wrench.force, force), clampLength(wrench.torque, torque)};
}

dvec3 shortenedBy(const dvec3& v, double by) noexcept {
    return clampLength(v, std::max(0.0, glm::length(v) - by));
}

dvec3 limitSlew(const dvec3& wanted, const dvec3& previous, double rise, double fall) noexcept {
    if (fall <= rise) {
        return previous + clampLength(wanted - previous, rise);
    }
    const dvec3 kept = wantedPart(previous, wanted);
    const dvec3 next = kept + clampLength(wanted - kept, rise) + shortenedBy(previous - kept, fall);
    return clampLength(next, std::max(glm::length(wanted), glm::length(previous)));
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
