// SPDX-License-Identifier: Apache-2.0
// Organised point clouds in PLY files: ascii, binary little-endian and big-endian.
#pragma once

#include "devices/pcd/pcd_file.h"

namespace fathom {

// Width and height come from obj_info or comment (num_cols and num_rows, width and height), or from the
// viewport of an element camera. Points lie row by row, or an element range_grid says which point each pixel
// has. Throws BadInput naming the file and the header's line, also for a cloud that states no size.
PcdCloud readPlyCloud(const std::filesystem::path& file);

} // namespace fathom
