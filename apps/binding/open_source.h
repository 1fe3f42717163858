// SPDX-License-Identifier: Apache-2.0
// Opens the cameras that a scene or --source names.
#pragma once

#include "devices/camera.h"
#include "engine/run/open_scene.h"

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

namespace fathom {

// Help text of --source.
inline constexpr const char* kSourceHelp = "instead of the scene's camera: a recording, or a live camera as "
                                           "v4l2:auto, openni2 or ros2:depth=TOPIC; see "
                                           "man fathom, SOURCES";

// For a live camera: the newest frame at each call, or every frame in order (for recordings).
enum class Delivery { Newest, Every };

// A recording or a live camera ("v4l2:..."), as --source names it. farthest [m]: beyond, readings do not
// matter. Throws BadInput.
std::unique_ptr<Camera> openSource(const std::string& source, Delivery delivery,
                                   double farthest = std::numeric_limits<double>::infinity());

// The scene's camera, or `source` when given: a recording, or a live camera ("v4l2:..."). Throws BadInput.
std::unique_ptr<Camera> openCamera(const Scene& scene, const std::optional<std::filesystem::path>& source,
                                   Delivery delivery = Delivery::Newest);

// Adds the uncertainty of the camera's own corrections (flat port) to the scene's registration sigma, which
// grows the regions. Call once per scene and camera.
void takeUncertainty(Scene& scene, const Camera& camera);

} // namespace fathom
