// SPDX-License-Identifier: Apache-2.0
/// @file
/// Poses, wrenches and times. SI units throughout.
#pragma once

#include <fathom/export.h>

#include <array>
#include <cstdint>

namespace fathom::v0 {

/// x, y, z.
using Vec3 = std::array<double, 3>;

/// Unit quaternion. Non-unit input is normalised.
struct Quaternion {
    double w = 1.0; ///< cos(angle / 2)
    double x = 0.0; ///< sin(angle / 2) times the axis
    double y = 0.0; ///< as x
    double z = 0.0; ///< as x
};

/// Rigid pose. A pose named aTb maps points from frame b to frame a.
struct Pose {
    Vec3 position{};       ///< [m]
    Quaternion rotation{}; ///< of the axes of frame b
};

/// Force [N] and torque [N m]. Each use says in which axes and about which point.
struct Wrench {
    Vec3 force{};  ///< [N]
    Vec3 torque{}; ///< [N m]
};

/// Nanoseconds of CLOCK_MONOTONIC, which std::chrono::steady_clock uses. Every stamp and every `now` of this
/// library is on this clock.
using Nanoseconds = std::int64_t;

/// The current time on that clock. Any thread.
FATHOM_API Nanoseconds now() noexcept;

/// The library's version, for example "0.2.0".
FATHOM_API const char* version() noexcept;

} // namespace fathom::v0
