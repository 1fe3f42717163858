// SPDX-License-Identifier: Apache-2.0
// JSON of other programs that may hold the poses of a camera.
#pragma once

#include <cstddef>
#include <filesystem>

namespace fathom {

// Whether JSON has a key of camera poses, Record3D's list "poses" of lists at its top level, or under one key
// at least `fewest` motions or quaternions that differ. Builds no values: a file of any depth takes little
// memory.
bool holdsJsonPoses(const std::filesystem::path& file, size_t fewest);

} // namespace fathom
