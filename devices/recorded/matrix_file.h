// SPDX-License-Identifier: Apache-2.0
// Text files of one matrix: lenses of ScanNet, poses of ScanNet and 7-Scenes.
#pragma once

#include "devices/recorded/recording_index.h"

#include <array>

namespace fathom {

// 4 x 4, row by row.
inline constexpr std::array<double, 16> kIdentityMatrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// 4 x 4 numbers, or 3 x 3 if orThree, as 4 x 4, row by row. Throws BadInput.
std::array<double, 16> readMatrix(const std::filesystem::path& file, bool orThree = false);

// rows: rotation, row by row. position [m]. file: named by the BadInput thrown for what is no rigid motion.
Pose rigidPose(const std::array<double, 9>& rows, const dvec3& position, const std::string& file);

// Sets the line's pose (base_T_camera); for a pose that is missing, was lost (-inf) or cannot be read, its
// fault. Returns whether the file exists.
bool usePose(IndexLine& line, const std::filesystem::path& file);

} // namespace fathom
