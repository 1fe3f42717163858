// SPDX-License-Identifier: Apache-2.0
// Opens a scene file: scene, arm and tool.
#pragma once

#include "engine/contact/tool.h"
#include "engine/cycle/arm_setup.h"
#include "engine/scene/scene.h"

#include <filesystem>
#include <memory>

namespace fathom {

// Reads and checks the scene file, names of device presets included. Throws BadInput.
Scene openScene(const std::filesystem::path& file);
// The same for a text; messages call it "scene text".
Scene openSceneText(const std::string& text);

// Logs a warning when a length [m] is over the usual `most`. what: "FILE: subject and verb".
void warnIfLong(const std::string& what, double length, double most);

// The scene's arm, or null without one; logs a warning for each note of its model. Throws BadInput.
std::unique_ptr<ArmSetup> openArm(const Scene& scene, const ReaderOptions& reader = {});

// The scene's tool: listed spheres or a sphere file; with an arm, what its tip carries, the scene's tool
// included. Throws BadInput.
Tool openTool(const Scene& scene, const ArmSetup* arm = nullptr, const ReaderOptions& reader = {});

} // namespace fathom
