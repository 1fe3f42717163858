// SPDX-License-Identifier: Apache-2.0
// Constants of angles.
#pragma once

#include <numbers>

namespace fathom {

inline constexpr double kTurn = 2.0 * std::numbers::pi;     // [rad]
inline constexpr double kDegree = std::numbers::pi / 180.0; // [rad]

} // namespace fathom
