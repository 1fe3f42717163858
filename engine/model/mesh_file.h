// SPDX-License-Identifier: Apache-2.0
// Reads STL, OBJ and COLLADA meshes.
#pragma once

#include "engine/model/triangle_mesh.h"

#include <filesystem>
#include <optional>

namespace fathom {

// What a mesh file does not say of itself.
struct MeshOptions {
    std::optional<double>
        scale;          // metres a unit of the file, on top of the unit that a .dae declares; empty: 1
    dvec3 stretch{1.0}; // of each axis of the file, finite and not 0, on top of that; below 0 it is mirrored
    char up = 0;        // 'x', 'y', 'z': the file's axis that becomes +z; 0 = no rotation
    bool dropStray = false; // leave out pieces far away instead of refusing them
};

// A mesh in metres, and what was found in its file.
struct LoadedMesh {
    TriangleMesh mesh; // [m], tidy
    MeshFacts facts;
    std::string doubt; // that its unit is none that was meant, in words; empty = none
};

// Node transforms are applied; a .dae's <unit> is applied, its <up_axis> is not (as ROS programs do). Throws
// BadInput: no such file, nothing in it, numbers that are not finite, an extent outside 1 mm .. 10 m (most
// often a unit that nobody said), stray geometry when it is not to be dropped.
LoadedMesh loadMesh(const std::filesystem::path& file, const MeshOptions& options = {});

// "2 pieces up to 19.8 m away from the rest"
std::string strayText(const MeshFacts& facts);

} // namespace fathom
