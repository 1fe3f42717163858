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

// Searched below arm.meshes, or in the URDF's folder and the three above it; with the package's name as a
// folder, and without it where nothing says that the file is of another package, such as the folder's
// package.xml, which gives only a note below arm.meshes if the URDF names one package. Capitals differ only
// where no file has the name itself. Throws ShapeRefused.
MeshPlace findMesh(const std::string& name, const ShapeSource& source);

} // namespace fathom
