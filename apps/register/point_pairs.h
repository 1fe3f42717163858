// SPDX-License-Identifier: Apache-2.0
// Corresponding points in the camera frame and the base frame, from a file.
#pragma once

#include "apps/register/rigid_fit.h"

#include <filesystem>
#include <vector>

namespace fathom {

// Whether a point is within 1000 km of the origin; a target also of usable quaternion, 1 mm to 10 m large.
bool isNear(const dvec3& p);
bool isNear(const Pose& target, double size);

// CSV rows "camera_x,camera_y,camera_z,base_x,base_y,base_z" [m]; lines with # are comments. Throws BadInput.
std::vector<PointPair> readPointPairs(const std::filesystem::path& file);

} // namespace fathom
