// SPDX-License-Identifier: Apache-2.0
// Copies the files that a scene file names, so that a copy of the scene can be loaded elsewhere.
#pragma once

#include "engine/scene/scene.h"

#include <filesystem>
#include <string>

namespace fathom {

// Copies the spheres of the tool, the description of the arm with its meshes and included files, and the hand
// path into `folder`, under their paths relative to the scene file. Returns a list of files, and of folders
// with meshes, outside the folder of the scene file, which are skipped; empty = none. Throws
// std::filesystem::filesystem_error, and BadInput when the arm's description cannot be read.
std::string copySceneFiles(const Scene& scene, const std::filesystem::path& folder);

} // namespace fathom
