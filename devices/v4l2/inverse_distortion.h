// SPDX-License-Identifier: Apache-2.0
// Some cameras report inverse Brown-Conrady coefficients (undistort); Intrinsics uses the forward ones
// (distort).
#pragma once

#include "engine/types/camera_info.h"

#include <array>

namespace fathom {

// Forward coefficients k1 k2 p1 p2 k3, fitted by least squares over the whole image of `lens` (whose own
// distortion is ignored) to the inverse ones. All zero stays all zero.
std::array<double, 5> forwardDistortion(const Intrinsics& lens, const std::array<double, 5>& undistorting);

} // namespace fathom
