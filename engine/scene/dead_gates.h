// SPDX-License-Identifier: Apache-2.0
// Gates that no point can pass, found before the run from scene and camera alone.
#pragma once

#include "engine/scene/scene.h"
#include "engine/types/camera_info.h"

#include <string>
#include <vector>

namespace fathom {

// One sentence per class of points that cannot get a point, and one when the depth unit leaves few values
// between near and far.
std::vector<std::string> deadGates(const Scene& scene, const CameraInfo& camera);

} // namespace fathom
