// SPDX-License-Identifier: Apache-2.0
// Checks the ranges of a camera's own description, whichever file or device it comes from.
#pragma once

#include "engine/types/camera_info.h"

#include <string>

namespace fathom {

inline constexpr double kFarthestColour = 10.0; // [m] from the depth camera, per axis

inline constexpr double kLeastDepthUnit = 1e-7; // [m]
inline constexpr double kMostDepthUnit = 1.0;   // [m]

// Throws BadInput that names `source`, the field, its value and what is allowed: lenses whose rays or pixel
// spacing are absurd, distances that float32 cannot hold, NaN.
void checkCamera(const CameraInfo& camera, const std::string& source);

// Whether checkCamera() accepts this lens.
bool isUsableLens(const Intrinsics& lens);

} // namespace fathom
