// SPDX-License-Identifier: Apache-2.0
// The file that a mesh name of a URDF refers to.
#pragma once

#include <filesystem>
#include <string>

namespace fathom {

struct ShapeSource;

// A mesh file, and a note for the user when it may be of another package; empty = none.
struct MeshPlace {
    std::filesystem::path file;
    std::string note;
    bool otherCapitals = false; // than the name has
};

// Searches below arm.meshes, or in the URDF's folder and the three above it: first with the package's name as
// a folder, then without. A package.xml of another package rejects the file, or below arm.meshes gives a note
// if the URDF names only one package. Exact capitals are preferred. Throws ShapeRefused.
MeshPlace findMesh(const std::string& name, const ShapeSource& source);

} // namespace fathom
