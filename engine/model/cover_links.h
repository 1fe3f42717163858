// SPDX-License-Identifier: Apache-2.0
// Covers the collision shapes of an arm's links with spheres, on all processors.
#pragma once

#include "engine/model/link_spheres.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// A shape and the link that it belongs to.
struct LinkGeometry {
    std::string link; // name
    std::shared_ptr<const urdf::Geometry> shape;
};

// Returns one result per shape, in order. Throws BadInput for the first shape that is rejected; it names the
// URDF and link, or the mesh file.
std::vector<ShapeSpheres> spheresOf(std::span<const LinkGeometry> shapes, ShapeSource source,
                                    uint32_t leaves);

// What spheresOf() logs every 5 s. cached: covers that are in the cache's folder, which has those of meshes
// only.
std::string coverProgressText(size_t done, size_t all, size_t cached, const std::filesystem::path& folder);

} // namespace fathom
