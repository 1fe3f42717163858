// SPDX-License-Identifier: Apache-2.0
// Chooses where an arm begins and ends in the tree of a URDF.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <urdf_model/model.h>
#include <vector>

namespace fathom {

struct ArmEnds {
    std::shared_ptr<const urdf::Link> base, tip;
    std::string baseWhy, tipWhy;    // "named by the scene", "the root", ...
    std::vector<std::string> notes; // doubtful choices, for a warning
};

// base, tip: names of links; empty = chosen. The base is the root, or the link below the last planar or
// floating joint. The tip is the frame with a usual name (tool0, flange, hand, ...) on the longest chain of
// moving joints without the gripper's; without one it is the end of that chain, or a bare frame fixed to it.
// Gripper joints are recognised by their names, as mimic joints, by alike branches at the end of a chain, and
// as jaws that slide across it.
// Throws BadInput for an unknown name.
ArmEnds chooseEnds(const urdf::ModelInterface& model, const std::filesystem::path& file,
                   const std::string& base, const std::string& tip);

} // namespace fathom
