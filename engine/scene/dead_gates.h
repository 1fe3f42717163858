// SPDX-License-Identifier: Apache-2.0
// Gates that no point can pass, and keys without effect or with another one than expected, found before the
// run from scene and camera alone.
#pragma once

#include "engine/scene/scene.h"
#include "engine/types/camera_info.h"

#include <string>
#include <vector>

namespace fathom {

// One sentence per class of points that cannot get a point, and one when the depth unit leaves few values
// between near and far.
std::vector<std::string> deadGates(const Scene& scene, const CameraInfo& camera);

// One sentence per class of points with keys that its role does not use and whose values are not the
// defaults. Not rejected: the window keeps them when it changes a role.
std::vector<std::string> unusedKeys(const Scene& scene);

// One sentence per class whose hues are one number, or shares of 1 rather than degrees as in other programs.
std::vector<std::string> hueNotes(const Scene& scene);

// One sentence per line and axis: a guidance role suggests a button and the limits of guidance_pull, and
// neither applies.
std::vector<std::string> equalityNotes(const Scene& scene);

} // namespace fathom
