// SPDX-License-Identifier: Apache-2.0
// One collision shape of a URDF link as spheres.
#pragma once

#include "engine/types/sphere_tree.h"

#include <filesystem>
#include <string>
#include <urdf_model/link.h>
#include <vector>

namespace fathom {

// Where a shape's meshes are looked for, and how many spheres it may have.
struct ShapeSource {
    std::filesystem::path urdf;   // file names of meshes are looked for beside it and above,
    std::filesystem::path meshes; // or here, unless empty
    uint32_t leaves = 64;         // spheres of a box, cylinder or mesh, at most
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

// A sphere stays one. Throws ShapeRefused for sizes that cannot be, BadInput for a mesh file. Any thread.
ShapeSpheres linkSpheres(const urdf::Geometry& shape, const ShapeSource& source);

} // namespace fathom
