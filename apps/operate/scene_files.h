// SPDX-License-Identifier: Apache-2.0
// The files that a scene file names, so that a copy of it elsewhere can be read.
#pragma once

#include "engine/scene/scene.h"

#include <filesystem>
#include <string>

namespace fathom::operate {

// Copies the tool's spheres, the arm's description and the hand's path into `folder`, under the names that
// they have beside the scene file. Returns those that lie outside of the scene file's folder and so are left,
// in words; empty = none. Throws std::filesystem::filesystem_error.
std::string copySceneFiles(const Scene& scene, const std::filesystem::path& folder);

} // namespace fathom::operate
