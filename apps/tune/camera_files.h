// SPDX-License-Identifier: Apache-2.0
// The files that a scene's camera.source names: its recording, and those behind commas.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fathom::tune {

// A path in a scene at `home`, as one in a scene at `folder` that leads to the same file. Absolute ones stay.
std::string movedPath(const std::filesystem::path& path, const std::filesystem::path& home,
                      const std::filesystem::path& folder);

// The value of camera.source.`kind` ("recorded", "v4l2" or "ros2") for a scene at `folder`. The recording
// stays where it is, as do files of options such as ,intrinsics=FILE outside of `home`.
std::string movedSource(const std::string& kind, const std::string& value, const std::filesystem::path& home,
                        const std::filesystem::path& folder);

// Files of such options within the folder of the scene, as paths relative to it.
std::vector<std::filesystem::path> filesBesideScene(const std::string& source);

} // namespace fathom::tune
