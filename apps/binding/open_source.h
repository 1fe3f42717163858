// SPDX-License-Identifier: Apache-2.0
// From what a scene names to what the engine runs on: cameras and tools.
#pragma once

#include "devices/camera.h"
#include "engine/contact/tool.h"
#include "engine/scene/scene.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace fathom {

// The scene file, read and checked, names of device presets included. Throws BadInput.
Scene openScene(const std::filesystem::path& file);

// The scene's camera, or the recording in `source` when given. Throws BadInput.
std::unique_ptr<Camera> openCamera(const Scene& scene, const std::optional<std::filesystem::path>& source);

// The scene's tool: listed spheres or a .sph file. Throws BadInput.
Tool openTool(const Scene& scene);

} // namespace fathom
