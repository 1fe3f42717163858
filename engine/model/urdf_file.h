// SPDX-License-Identifier: Apache-2.0
// Opens URDF files; its names are urdfdom's.
#pragma once

#include "engine/types/pose.h"

#include <filesystem>
#include <memory>
#include <urdf_model/model.h>

namespace fathom {

// Never null. Throws BadInput with what the parser said.
std::shared_ptr<const urdf::ModelInterface> readUrdf(const std::filesystem::path& file);

// The same pose in this project's type [m], the quaternion of unit length.
Pose poseOf(const urdf::Pose& pose);

} // namespace fathom
