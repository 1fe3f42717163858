// SPDX-License-Identifier: Apache-2.0
// Parses URDF files with urdfdom.
#pragma once

#include "engine/types/pose.h"

#include <filesystem>
#include <memory>
#include <urdf_model/model.h>

namespace fathom {

// Never null. Throws BadInput with the parser's message.
std::shared_ptr<const urdf::ModelInterface> readUrdf(const std::filesystem::path& file);

// Converts a pose [m]; the quaternion is normalised.
Pose poseOf(const urdf::Pose& pose);

} // namespace fathom
