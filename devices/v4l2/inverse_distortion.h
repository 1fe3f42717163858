// SPDX-License-Identifier: Apache-2.0
// Some cameras tell the Brown-Conrady coefficients that undistort; Intrinsics has those that distort.
#pragma once

#include "engine/types/camera_info.h"

#include <array>

namespace fathom {

// k1 k2 p1 p2 k3 that distort, fitted by least squares over the whole picture of `lens` (its own distortion
// is not read) to the ones that undistort. All zero stays all zero.
std::array<double, 5> forwardDistortion(const Intrinsics& lens, const std::array<double, 5>& undistorting);

} // namespace fathom
