// SPDX-License-Identifier: Apache-2.0
// The hand's path as a CSV file (`--operator`, hand.path).
#pragma once

#include "devices/simulated/hand_path.h"

#include <filesystem>
#include <vector>

namespace fathom {

// Header line t_s,x,y,z,qw,qx,qy,qz[,button], then one row per waypoint: t [s] strictly increasing, position
// [m] and orientation in the device frame (quaternion within 5 % of length 1, normalised here), button the
// bits of haptic_device.h by level (0 without that column). Blank lines and # comments are skipped. At least
// one row, at most ten million. Throws BadInput with file, line and column. Logs a warning for rows that end
// before t = 0, and for times that look like those of a smaller unit.
std::vector<HandWaypoint> readHandCsv(const std::filesystem::path& file);

} // namespace fathom
