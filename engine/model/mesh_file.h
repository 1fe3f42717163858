// SPDX-License-Identifier: Apache-2.0
// Reads STL, OBJ and COLLADA meshes.
#pragma once

#include "engine/model/triangle_mesh.h"

#include <filesystem>

namespace fathom {

struct MeshOptions {
    double scale = 1.0;     // metres a unit of the file, on top of the unit that a .dae declares
    char up = 0;            // 'x', 'y', 'z': the file's axis that becomes +z; 0 = no rotation
    bool dropStray = false; // leave out pieces far away instead of refusing them
};

struct LoadedMesh {
    TriangleMesh mesh; // [m], tidy
    MeshFacts facts;
};

// Node transforms are applied; a .dae's <unit> is applied, its <up_axis> is not (as ROS programs do). Throws
// BadInput: no such file, nothing in it, numbers that are not finite, an extent outside 1 mm .. 10 m (most
// often a unit that nobody said), stray geometry when it is not to be dropped.
LoadedMesh loadMesh(const std::filesystem::path& file, const MeshOptions& options = {});

} // namespace fathom
