// SPDX-License-Identifier: Apache-2.0
// Numbers that the files of the proxy share.
#pragma once

#include <cstddef>

namespace fathom::proxy {

// Rows ask for this much more than the gap, so that the rounding of the solver (some 1e-13 of the step) never
// reaches the exact check, which has no tolerance at all.
inline constexpr double kSkin = 1e-9; // [m]
// Rows that ask for more than this ask for motion: an escape. Well above the skin.
inline constexpr double kEscapeThreshold = 4e-9; // [m]
inline constexpr double kNothing = 1e-9; // [m], [rad] a step this short moved nothing worth another solve
inline constexpr double kEqualityRest = 1e-9; // [m], [rad] lines and axes: rounding about this is at rest
inline constexpr size_t kMostPairRows = 512;
inline constexpr size_t kMostRows = 1280; // the rest: shapes, behind, and rows for violated pairs
inline constexpr size_t kMostViolations = 64;
inline constexpr int kRounds = 8;
inline constexpr int kBisections = 14;

} // namespace fathom::proxy
