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

// Where a shape's meshes are looked for.
struct ShapeSource {
    std::filesystem::path urdf;   // file names of meshes are looked for beside it and above,
    std::filesystem::path meshes; // or here, unless empty
};

// Thrown: the value that cannot be, and what is allowed instead. The caller knows the file and the link.
struct ShapeRefused {
    std::string value, allowed;
};

// The spheres of one shape, and what a person should be told of them.
struct ShapeSpheres {
    std::vector<Sphere> spheres;    // in the shape's own frame [m]
    std::vector<std::string> notes; // what about its file may not be as it was meant, a line each
    std::filesystem::path outside; // that file, where it lies outside of the folder that it was looked for in
};

// A shape whose file has been read.
struct LinkShape {
    std::optional<LoadedMesh> surface; // none = a sphere already, the one in `made`
    ShapeSpheres made;                 // what is known of its spheres so far

    size_t points() const { return surface ? surface->mesh.points.size() : 0; }
};

// Throws ShapeRefused for sizes that cannot be, BadInput for a mesh file. While no other thread works: a mesh
// is read in a child (runReader).
LinkShape readLinkShape(const urdf::Geometry& shape, const ShapeSource& source);

// A sphere stays one; a box, cylinder or mesh gets `leaves` at most. Throws ShapeRefused. Any thread.
ShapeSpheres linkSpheres(LinkShape shape, uint32_t leaves);

} // namespace fathom
