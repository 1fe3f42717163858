// SPDX-License-Identifier: Apache-2.0
// Recognises text files that hold the poses of a moving camera, whatever their names.
#pragma once

#include <filesystem>
#include <span>

namespace fathom {

// Whether the first lines of numbers are poses: a unit quaternion at one place of each, or the rows of a
// rigid motion, in a line or on lines of their own. False for one pose alone, and for a file that cannot be
// read.
bool holdsPoses(const std::filesystem::path& file);

// Whether 12 or more numbers are three rows of a rotation with a position behind each.
bool isMotion(std::span<const double> rows);

} // namespace fathom
