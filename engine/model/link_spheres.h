// SPDX-License-Identifier: Apache-2.0
// One collision shape of a URDF link as spheres.
#pragma once

#include "engine/model/find_mesh.h"
#include "engine/model/mesh_file.h"
#include "engine/types/sphere_tree.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <urdf_model/link.h>
#include <vector>

namespace fathom {

// Where meshes are searched.
struct ShapeSource {
    std::filesystem::path urdf;    // mesh file names are searched in its folder and the parents,
    std::filesystem::path meshes;  // or here, unless empty
    bool keepStray = false;        // keep pieces far from the rest of a mesh
    ReaderOptions reader{};        // of the processes that read them
    std::set<std::string> names{}; // of all meshes of the URDF, to tell their packages apart
};

// Exception: the rejected value and what is allowed. The caller adds the file and the link.
struct ShapeRefused {
    std::string value, allowed;
};

// The spheres of one shape, and notes for the user.
struct ShapeSpheres {
    std::vector<Sphere> spheres;    // in the shape's own frame [m]
    std::vector<std::string> notes; // one warning about its file per line
    std::filesystem::path outside;  // the file, when it is outside the folder that was searched
    bool open = false;              // a mesh that is not closed: only its surface is covered
};

// A shape whose file has been read.
struct LinkShape {
    std::optional<LoadedMesh> surface; // empty = the shape is a sphere, the one in `made`, or of size 0
    ShapeSpheres made;                 // its spheres and notes so far

    size_t points() const { return surface ? surface->mesh.points.size() : 0; }
};

// The file of a shape that is a mesh, as readLinkShape() reads it; empty for other shapes. Throws
// ShapeRefused when it is missing.
MeshPlace meshFileOf(const urdf::Geometry& shape, const ShapeSource& source);

// The file if it is outside the folder that is searched, else empty.
std::filesystem::path outsideOf(const std::filesystem::path& file, const ShapeSource& source);

// A shape of size 0 gives a note and no spheres. Throws ShapeRefused for negative sizes and missing meshes,
// and BadInput for a bad mesh file. Any thread.
LinkShape readLinkShape(const urdf::Geometry& shape, const ShapeSource& source);

// A sphere is kept; a box, cylinder, capsule or mesh gets at most `leaves` spheres. Throws ShapeRefused. Any
// thread.
ShapeSpheres linkSpheres(LinkShape shape, uint32_t leaves);

} // namespace fathom
