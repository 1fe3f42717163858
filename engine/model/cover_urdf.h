// SPDX-License-Identifier: Apache-2.0
// Sphere sets for every link of a URDF, whatever its collision shapes.
#pragma once

#include "engine/model/sphere_sets.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// The spheres that cover the shapes of a URDF.
struct UrdfCover {
    std::vector<LinkSpheres> links; // with spheres, in the order of names
    std::vector<std::string> notes; // warnings, one line each
};

// meshes: root of package:// paths; empty = the URDF's folder and its parents. leaves: for each box, cylinder
// and mesh. Throws BadInput.
UrdfCover coverUrdf(const std::filesystem::path& file, const std::filesystem::path& meshes, uint32_t leaves,
                    bool keepStray, const ReaderOptions& reader = {});

} // namespace fathom
