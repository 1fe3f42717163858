// SPDX-License-Identifier: Apache-2.0
// Copies the files that a scene file names, so that a copy of the scene can be loaded elsewhere.
#pragma once

#include "engine/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

enum class Copying { Check, Do }; // Check: only whether Do would throw BadInput

// Copies `file` to `to`/name. A file with the same bytes stays. Throws BadInput when anything else is in
// the way: no file is replaced, and no link below `to` is followed.
void copyFile(const std::filesystem::path& file, const std::filesystem::path& to,
              const std::filesystem::path& name, Copying how);

// Copies the spheres of the tool, the description of the arm with its meshes and included files, and the hand
// path into `folder`, under their paths relative to the scene file. Returns a list of files, and of folders
// with meshes, outside the folder of the scene file, which are skipped; empty = none. Throws as copyFile(),
// std::filesystem::filesystem_error, and BadInput when the arm's description cannot be read.
std::string copySceneFiles(const Scene& scene, const std::filesystem::path& folder,
                           Copying how = Copying::Do);

// The files that copySceneFiles() copies, as paths relative to the scene file. Throws as it does.
std::vector<std::filesystem::path> filesBeside(const Scene& scene);

} // namespace fathom
