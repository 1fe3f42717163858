// SPDX-License-Identifier: Apache-2.0
// The Falcon's mechanism: three legs between a base and a knob that only translates.
// Source: R. E. Stamper, A Three Degree of Freedom Parallel Manipulator with Only Translational Degrees of
// Freedom (PhD 97-4, 1997), whose letters the names follow; lengths as stated by libnifalcon.
#pragma once

#include "engine/types/pose.h"

#include <array>
#include <cstdint>
#include <optional>

namespace fathom {

using LegAngles = std::array<double, 3>; // [rad] of the driven joints, theta1 of each leg

// Device frame: origin in the base, z out of the base along the device's axis towards the pilot, y up. The
// knob's home is near (0, 0, 0.135).
class FalconKinematics {
public:
    static LegAngles anglesOf(const std::array<int16_t, 3>& encoder) noexcept;
    static std::array<int16_t, 3> encoderOf(const LegAngles& angles) noexcept; // nearest counts

    // Empty when a leg cannot reach the position.
    static std::optional<LegAngles> inverse(const dvec3& knob) noexcept;
    // Newton's method from `guess`; empty when it does not converge to 1 nm in 30 steps or ends more than 0.1
    // m from home.
    static std::optional<dvec3> forward(const LegAngles& angles, const dvec3& guess = kHome) noexcept;

    // Joint torques [N m] that hold against the negative of `force` [N] on the knob: tau = (dp/dtheta)^T f.
    // Empty at a singular pose.
    static std::optional<std::array<double, 3>> torques(const dvec3& knob, const LegAngles& angles,
                                                        const dvec3& force) noexcept;

    static constexpr dvec3 kHome{0.0, 0.0, 0.1346}; // [m] of the knob, device frame
};

} // namespace fathom
