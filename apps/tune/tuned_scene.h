// SPDX-License-Identifier: Apache-2.0
// The scene file that `fathom tune` writes.
#pragma once

#include "apps/tune/scene_text.h"
#include "apps/tune/tuner.h"
#include "engine/types/output_file.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace fathom::tune {

// Values of the settings that were varied, each with its reason as comment. One that stays as it was is
// written, too, so that a later default does not change it.
std::vector<SceneValue> chosenValues(const TuneResult& result, const TunePoint& chosen);

// Files that the scene names, as seen from another folder: those that writeTunedScene() does not copy there,
// and the recording of the camera.
std::vector<SceneValue> movedPaths(const std::string& text, const std::filesystem::path& home,
                                   const std::filesystem::path& folder);

// Start of the head of a scene.
inline constexpr const char* kWrittenBy = "written by 'fathom tune'";

// Writes `folder`/scene.yaml: the text of the scene with these values, and `head`, which begins with
// kWrittenBy, as comment at the top. Copies the files in its folder that it names. Replaces an older file
// only when the new one loads with the chosen setting; just before, it commits `others` without a scene.
// Throws BadInput or Error.
std::filesystem::path writeTunedScene(const Scene& scene, const Setting& chosen,
                                      const std::vector<SceneValue>& values, const std::string& head,
                                      const std::filesystem::path& folder,
                                      std::span<OutputFile* const> others = {});

// Commits the other results. Removes an older `scene` first, which must not be beside newer ones, but only
// when all are complete, so that a full disk leaves all as they were.
void commitWithoutScene(std::span<OutputFile* const> others, const std::filesystem::path& scene);

// Name of the file. Throws BadInput when `folder` has a file of this name that is the scene itself, or that
// no earlier run wrote, when a file of the scene has the name of a result, and when something is in the way
// of a file that writeTunedScene() copies there.
std::filesystem::path tunedSceneFile(const Scene& scene, const std::filesystem::path& folder);

} // namespace fathom::tune
