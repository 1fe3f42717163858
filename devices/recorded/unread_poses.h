// SPDX-License-Identifier: Apache-2.0
// Poses of a recording folder in files that are not read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace fathom {

// For a folder whose camera counts as fixed: the file or folder in it, or one level below or in sparse/0/,
// that holds poses by its name, lines or JSON keys ("groundtruth.txt", "scene/trajectory.log", "metadata",
// "pose/"), with what to do; empty = none. images: of the recording. JSON with motions for fewer than half of
// them is no trajectory, unless a key says so.
std::string unreadPoses(const std::filesystem::path& folder, size_t images = 0);

} // namespace fathom
