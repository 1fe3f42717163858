// SPDX-License-Identifier: Apache-2.0
// From what a scene names to what the engine runs on: cameras and tools.
#pragma once

#include "devices/camera.h"
#include "engine/contact/tool.h"
#include "engine/cycle/arm_rig.h"
#include "engine/scene/scene.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace fathom {

// The scene file, read and checked, names of device presets included. Throws BadInput.
Scene openScene(const std::filesystem::path& file);

// What --source takes.
inline constexpr const char* kSourceHelp =
    "in place of the scene's camera: a recording folder, a ROS bag, "
    "an organised PCD, an .oni file, or a live camera as v4l2:auto or openni2";

// Of a live camera: the newest at each call, or every one in order (for recordings).
enum class Images { Newest, Every };

// The scene's camera, or `source` when given: a recording, or a live camera ("v4l2:..."). Throws BadInput.
std::unique_ptr<Camera> openCamera(const Scene& scene, const std::optional<std::filesystem::path>& source,
                                   Images images = Images::Newest);

// What the camera's own corrections leave uncertain (of a flat port) makes the scene's regions grow as a
// registration does. Once a scene and camera.
void takeUncertainty(Scene& scene, const Camera& camera);

// The scene's arm, or null where it has none; a warning for each of its model's notes. Throws BadInput.
std::unique_ptr<ArmRig> openArm(const Scene& scene);

// The scene's tool: listed spheres or a .sph file; what the arm's tip carries, the scene's tool included,
// where there is an arm. Throws BadInput.
Tool openTool(const Scene& scene, const ArmRig* arm = nullptr);

} // namespace fathom
