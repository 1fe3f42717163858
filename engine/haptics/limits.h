// SPDX-License-Identifier: Apache-2.0
// The last stages of the wrench, as pure functions. All are noexcept and do not allocate.
#pragma once

#include "engine/haptics/device_preset.h"
#include "engine/types/pose.h"
#include "engine/types/wrench.h"

namespace fathom {

// All six numbers finite.
bool isFinite(const Wrench& wrench) noexcept;

// All six numbers zero.
bool isZero(const Wrench& wrench) noexcept;

// Force and torque times the factor.
Wrench scaled(const Wrench& wrench, double factor) noexcept;

// v along `axis` (of any length) only; zero for a zero axis.
dvec3 projectedOn(const dvec3& v, const dvec3& axis) noexcept;

// The part of v that lies along `wanted` and is at most as long: between zero and `wanted`.
dvec3 wantedPart(const dvec3& v, const dvec3& wanted) noexcept;

// Force and torque each shortened to their limit [N], [N m], same direction.
Wrench limitSize(const Wrench& wrench, double force, double torque) noexcept;

// v shorter by `by`, same direction; zero if it was not longer.
dvec3 shortenedBy(const dvec3& v, double by) noexcept;

// The force or torque after one tick. The part of `previous` that is not wanted becomes shorter by `fall`,
// including what opposes the wanted force or is perpendicular to it; what is wanted rises by `rise`. With a
// fall that is no larger it is one step of `rise` on the straight line. Never longer than the longer of both,
// so within the size limits.
dvec3 limitSlew(const dvec3& wanted, const dvec3& previous, double rise, double fall) noexcept;

// One-pole low-pass y += a (x - y), a = 1 - exp(-2 pi f T). Its delay in ticks is n = (1 - a)/a: with H =
// a/(1 - r z^-1), r = 1 - a, Re{(1 - e^-jw) H}/(1 - cos w) = a (1 + r)/|1 - r e^-jw|^2, whose supremum at w =
// 0 is (1 + r)/a = 1 + 2n. This is the delay term of the passivity bound in coupling.h. hz = 0 turns the
// filter off: a = 1, n = 0. period: of a tick [s].
double lowPassGain(double hz, double period) noexcept;
double lowPassDelayTicks(double gain) noexcept;
Wrench lowPass(const Wrench& input, const Wrench& previous, double gain) noexcept;

// Splits a wrench into what the device can render and what it cannot: delivered + residual = wrench, in base
// axes. Each axis of force and torque is masked in the handle frame (baseRhandle).
struct ProjectedWrench {
    Wrench delivered;
    Wrench residual;
};
ProjectedWrench projectOnAxes(const Wrench& wrench, const dquat& baseRhandle,
                              const AxisMask& actuated) noexcept;

} // namespace fathom
