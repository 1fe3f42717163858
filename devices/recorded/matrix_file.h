// SPDX-License-Identifier: Apache-2.0
// Text files of one matrix: lenses of ScanNet, poses of ScanNet and 7-Scenes.
#pragma once

#include "devices/recorded/png_image.h"
#include "devices/recorded/recording_index.h"
#include "engine/types/camera_info.h"

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// 4 x 4, row by row.
inline constexpr std::array<double, 16> kIdentityMatrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// 4 x 4 numbers, or 3 x 3 if orThree, as 4 x 4, row by row. Throws BadInput.
std::array<double, 16> readMatrix(const std::filesystem::path& file, bool orThree = false);

// The lens of a file of fx 0 cx, 0 fy cy, 0 0 1, with or without a fourth row and column, of images of this
// size. Throws BadInput; also without a size. Adds a warning of a skew, which is not used, and of a principal
// point as that of another image size.
Intrinsics matrixLens(const std::filesystem::path& file, std::optional<PngSize> size,
                      std::vector<std::string>& warnings);

// rows: rotation, row by row. position [m]. file, field: named by the BadInput thrown for what is no rigid
// motion.
Pose poseFromRows(const std::array<double, 9>& rows, const dvec3& position, const std::string& file,
                  const std::string& field);

// Rows of the matrix of a lens, for messages.
inline constexpr const char* kLensRows = "fx 0 cx, 0 fy cy, 0 0 1 with fx and fy above 0";
// Why these rows are no matrix of a lens, with the element: written column by column, as some programs do,
// focal lengths that are not above 0, or another last row. The skew is not looked at. Empty = they are one.
std::string lensFault(std::span<const double, 9> k);

// Sets the line's pose (base_T_camera); for a pose that is missing, was lost (-inf) or cannot be read, its
// fault. Returns whether the file exists.
bool usePose(IndexLine& line, const std::filesystem::path& file);

// A warning about poses of images that are farther apart, or farther from the origin, than a camera is moved;
// empty = none.
std::string fastPoses(const std::vector<IndexLine>& index);

} // namespace fathom
