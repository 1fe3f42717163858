// SPDX-License-Identifier: Apache-2.0
// One collision shape of a URDF link as spheres.
#pragma once

#include "engine/model/mesh_file.h"
#include "engine/types/sphere_tree.h"

#include <filesystem>
#include <optional>
#include <string>
#include <urdf_model/link.h>
#include <vector>

namespace fathom {

// Where meshes are searched.
struct ShapeSource {
    std::filesystem::path urdf;   // mesh file names are searched in its folder and the parents,
    std::filesystem::path meshes; // or here, unless empty
};

// Exception: the rejected value and what is allowed. The caller adds the file and the link.
struct ShapeRefused {
    std::string value, allowed;
};

// The spheres of one shape, and notes for the user.
struct ShapeSpheres {
    std::vector<Sphere> spheres;    // in the shape's own frame [m]
    std::vector<std::string> notes; // one line per doubt about its file
    std::filesystem::path outside;  // the file, when it is outside the folder that was searched
};

// A shape whose file has been read.
struct LinkShape {
    std::optional<LoadedMesh> surface; // empty = the shape is a sphere, the one in `made`
    ShapeSpheres made;                 // its spheres and notes so far

    size_t points() const { return surface ? surface->mesh.points.size() : 0; }
};

// Throws ShapeRefused for invalid sizes and BadInput for a mesh file. Call it while no other thread runs: a
// mesh is read in a child process (runReader).
LinkShape readLinkShape(const urdf::Geometry& shape, const ShapeSource& source);

// A sphere is kept; a box, cylinder or mesh gets at most `leaves` spheres. Throws ShapeRefused. Any thread.
ShapeSpheres linkSpheres(LinkShape shape, uint32_t leaves);

} // namespace fathom
