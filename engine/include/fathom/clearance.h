// SPDX-License-Identifier: Apache-2.0
/// @file
/// How far the tool would be from the protected regions at other poses: for planning, previews and displays.
#pragma once

#include <fathom/types.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace fathom::v0 {

/// The smallest gap of the tool at one pose, and the pair of spheres that has it. Exact in float64: no other
/// pair of the frame has a smaller gap, on any device. Of equal gaps the region's sphere that comes first in
/// the image counts, then the tool's sphere with the lowest index.
struct Clearance {
    /// [m] between the tool's surface and the region's; negative = they overlap. Infinity: nothing is
    /// protected. NaN: the pose is not finite. All else is meaningless then.
    double gap = std::numeric_limits<double>::infinity();
    std::uint32_t fixture = 0;   ///< of the region: index into the scene's fixtures
    std::uint32_t toolIndex = 0; ///< of the tool's sphere
    Vec3 toolCentre{};           ///< [m] of that sphere, in the tool's frame
    double toolRadius = 0.0;     ///< [m]
    Vec3 regionCentre{};         ///< [m] of the region's sphere, in the base frame
    double regionRadius = 0.0;   ///< [m]
};

/// Answers for one frame.
struct Clearances {
    std::int64_t frame = -1;      ///< number of the frame whose regions they are about; -1 = no frame yet
    Nanoseconds stamp = 0;        ///< of that frame, rounded to a microsecond
    std::vector<Clearance> poses; ///< one per pose, in order; empty before the first frame
};

} // namespace fathom::v0
