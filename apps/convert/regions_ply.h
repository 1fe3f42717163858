// SPDX-License-Identifier: Apache-2.0
// Reads the region spheres that `replay --save-fixtures` wrote.
#pragma once

#include "devices/bag/ros2_messages.h"

#include <filesystem>

namespace fathom {

// Throws BadInput for a file of another kind, or of another size than its header states.
std::vector<ros2::RegionPoint> readRegionsPly(const std::filesystem::path& file);

} // namespace fathom
