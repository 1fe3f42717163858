// SPDX-License-Identifier: Apache-2.0
// Corresponding points in the camera frame and the base frame, from a file.
#pragma once

#include "apps/register/rigid_fit.h"
#include "devices/recorded/text_file.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// Whether a point is within 1000 km of the origin; a target also of usable quaternion, 1 mm to 10 m large.
bool isNear(const dvec3& p);
bool isNear(const Pose& target, double size);

// The lines of a table that are neither blank nor comments, without its header: the first line may be exactly
// this one. Throws BadInput for another header.
std::vector<TextLine> readRows(const std::filesystem::path& file, const std::string& header);

// CSV rows "camera_x,camera_y,camera_z,base_x,base_y,base_z" [m]; lines with # are comments. Throws BadInput.
std::vector<PointPair> readPointPairs(const std::filesystem::path& file);

} // namespace fathom
