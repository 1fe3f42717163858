// SPDX-License-Identifier: Apache-2.0
// `fathom register SCENE.yaml`: where the camera is in the base frame, from tags that it sees or from points.
#pragma once

#include "apps/global_options.h"
#include "apps/register/rigid_fit.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

namespace fathom {

void addRegisterCommand(CLI::App& app, const GlobalOptions& global);

// CSV rows "camera_x,camera_y,camera_z,base_x,base_y,base_z" [m]; lines with # are comments. Throws BadInput.
std::vector<PointPair> readPointPairs(const std::filesystem::path& file);

} // namespace fathom
