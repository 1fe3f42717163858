// SPDX-License-Identifier: Apache-2.0
// MJCF, the format of MuJoCo, as URDF: bodies become links, joints and geoms become those that URDF has.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// Whether the root element of the text is <mujoco>.
bool isMjcf(const std::string& text);

// The URDF text of an MJCF file whose content is `text`, with included files from its folder. The world is
// the root link. Joint positions are those of MJCF minus `ref`. A body of several joints gets a link between
// each two. Geoms that touch nothing (contype and conaffinity 0) become visuals; an ellipsoid becomes the box
// around it. Ignored: actuators, tendons, sensors, contacts, geoms of the world. Throws BadInput naming line,
// element, attribute and value.
std::string urdfOfMjcf(const std::filesystem::path& file, const std::string& text,
                       std::vector<std::string>& notes);

} // namespace fathom
