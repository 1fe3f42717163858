// SPDX-License-Identifier: Apache-2.0
// The collision shapes of an arm's links as spheres, by all processors.
#pragma once

#include "engine/model/link_spheres.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// A shape, and whose it is.
struct LinkGeometry {
    std::string link; // name
    std::shared_ptr<const urdf::Geometry> shape;
};

// Of each shape, in their order. Throws BadInput, naming the URDF and the link, or the mesh file: the first
// refusal in that order. While no other thread works (readLinkShape).
std::vector<ShapeSpheres> spheresOf(std::span<const LinkGeometry> shapes, const ShapeSource& source,
                                    uint32_t leaves);

} // namespace fathom
